"""Prints the figures of docs/features/prosody.md: errors on sounds of known pitch and quality, and
what real speech in ../shared/data, or the folder in GESTUS_SHARED_DATA, gives.

usage: prosody_figures.py PROSODY_PROBE SOURCE_ROOT
"""
import os
import pathlib
import subprocess
import sys
import wave

import numpy as np

PROBE, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
DATA = pathlib.Path(os.environ.get("GESTUS_SHARED_DATA", ROOT / "../shared/data"))
RANDOM = np.random.default_rng(1)
EDGE = 15  # rows at both ends whose windows reach beyond the sound


def run(stage, x, rate, mode="textbook"):
    done = subprocess.run([PROBE, stage, str(rate), "0.01", "50", "550", mode, "1000000"],
                          input=np.asarray(x, "<f4").tobytes(), stdout=subprocess.PIPE, check=True)
    return np.frombuffer(done.stdout, "<f4").reshape(-1, 2 if stage == "swipe" else 6)


def harmonics(rate, hz, slope=1.0):
    t = np.arange(rate) / rate
    k = np.arange(1, int(min(6000, 0.45 * rate) // hz) + 1)[:, None]
    return 0.1 * (k ** -float(slope) * np.cos(2 * np.pi * k * hz * t + k * k)).sum(0)


def add_noise(x, decibels):
    noise = RANDOM.standard_normal(len(x))
    return x + noise * np.sqrt((x ** 2).mean() / (noise ** 2).mean() / 10 ** (decibels / 10))


def pulses(rate, hz, jitter, shimmer):
    odd = np.where(np.arange(int(hz)) % 2, -1, 1)
    x = np.zeros(rate)
    for time, level in zip(np.cumsum((1 + odd * jitter) / hz), 1 + odd * shimmer):
        u = np.arange(rate) / rate - time
        near = np.abs(u) < 0.004
        x[near] += level * np.exp(-(u[near] / 0.0007) ** 2) * np.cos(2 * np.pi * 700 * u[near])
    return 0.3 * x


def pitch():
    print("| rate | mode | noise | voiced | gross | mean error | largest |\n|---|---|---|---|---|---|---|")
    for rate in (8000, 16000, 22050, 44100, 48000):
        for mode in ("textbook", "sptk"):
            for decibels in (None, 20, 10):
                rows, errors = 0, []
                for hz in np.geomspace(58, 500, 25):
                    x = harmonics(rate, hz)
                    x = x if decibels is None else add_noise(x, decibels)
                    f0 = run("swipe", x, rate, mode)[EDGE:-EDGE, 0]
                    rows += len(f0)
                    errors.append(np.abs(f0[f0 > 0] / hz - 1))
                errors = np.concatenate(errors)
                fine = errors[errors <= 0.2]
                print(f"| {rate} | {mode} | {decibels} | {100 * len(errors) / rows:.1f} % | "
                      f"{100 * (errors > 0.2).mean():.2f} % | {100 * fine.mean():.2f} % | "
                      f"{100 * fine.max():.2f} % |")


def quality():
    pitches = (81, 120, 205, 310)
    for rate in (8000, 16000, 22050, 48000):
        rows = {"jitter": [], "shimmer": [], "Hammarberg": []}
        for hz in pitches:
            for d in (0, 0.002, 0.005, 0.01):
                out = run("quality", pulses(rate, hz, d, 0), rate)[EDGE:-EDGE]
                rows["jitter"].append(np.abs(out[:, 2] - 2 * d).max())
            for d in (0, 0.01, 0.05, 0.1):
                out = run("quality", pulses(rate, hz, 0, d), rate)[EDGE:-EDGE]
                rows["shimmer"].append(np.abs(out[:, 3] - 20 * np.log10((1 + d) / (1 - d))).max())
            for slope in (0, 1, 2):
                out = run("quality", harmonics(rate, hz, slope), rate)[EDGE:-EDGE]
                want = 20 * slope * np.log10(2000 // hz + 1)
                rows["Hammarberg"].append(np.abs(out[:, 5] - want).max())
        print(rate, *(f"{name}: largest error {max(errors):.2g};" for name, errors in rows.items()))
        for decibels in (0, 10, 20, 30, 40):
            out = np.concatenate([run("quality", add_noise(harmonics(rate, hz), decibels), rate)
                                  [EDGE:-EDGE] for hz in pitches])
            out = out[out[:, 0] > 0, 4] - decibels
            print(f"  HNR {decibels} dB: mean {out.mean():+.2f}, deviation {out.std():.2f}")


def speech():
    for path in ("arctic_a0007_swipe/arctic_a0007.wav", "mfa_acoustic_corpus/acoustic_corpus.wav"):
        if not (DATA / path).is_file():
            print(f"{DATA / path} is not there")
            continue
        with wave.open(str(DATA / path)) as w:
            x, rate = np.frombuffer(w.readframes(w.getnframes()), "<i2") / 32768, w.getframerate()
        rows = run("quality", x, rate)
        other = run("swipe", x, rate, "sptk")
        voiced = rows[:, 0] > 0
        both = voiced & (other[:, 0] > 0)
        middle = np.median(rows[voiced], axis=0)
        print(f"{path}: {len(rows)} rows, {voiced.sum()} voiced, medians f0 {middle[0]:.1f}, strength "
              f"{middle[1]:.2f}, jitter {100 * middle[2]:.2f} %, shimmer {middle[3]:.2f} dB, HNR "
              f"{middle[4]:.1f} dB, Hammarberg {middle[5]:.1f} dB; modes differ in the voicing of "
              f"{(voiced != (other[:, 0] > 0)).sum()} rows and by "
              f"{100 * np.abs(rows[both, 0] / other[both, 0] - 1).max():.2f} % at most")


if __name__ == "__main__":
    pitch()
    quality()
    speech()
