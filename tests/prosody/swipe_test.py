"""Compares the C++ of SWIPE' with its transcription in swipe_definition.py, and with SPTK itself on
real speech where ../shared/data, or the folder in GESTUS_SHARED_DATA, is at hand.

usage: swipe_test.py PROSODY_PROBE SOURCE_ROOT
"""
import os
import pathlib
import subprocess
import sys
import unittest
import wave

import numpy as np

import swipe_definition

PROBE, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
DATA = pathlib.Path(os.environ.get("GESTUS_SHARED_DATA", ROOT / "../shared/data"))


def run(x, rate, hop_seconds, low=50.0, high=550.0, mode="textbook", piece=1 << 20):
    done = subprocess.run(
        [PROBE, "swipe", str(rate), repr(hop_seconds), str(low), str(high), mode, str(piece)],
        input=np.asarray(x, "<f4").tobytes(), stdout=subprocess.PIPE, check=True)
    return np.frombuffer(done.stdout, "<f4").reshape(-1, 2)


def voice(rate, seconds, seed):
    """A gliding voice with pauses, formant-like weights and breath."""
    random = np.random.default_rng(seed)
    t = np.arange(int(rate * seconds)) / rate
    f0 = 140 * 2 ** (0.8 * np.sin(2 * np.pi * 0.7 * t + seed))
    phase = 2 * np.pi * np.cumsum(f0) / rate
    x = np.zeros(len(t))
    for k in range(1, 40):
        weight = 1 / k + 0.6 * np.exp(-((k * f0 - 700) / 200) ** 2)
        x += np.where(k * f0 < min(0.45 * rate, 7000), weight, 0) * np.cos(k * phase + k * k)
    x *= 0.05 * np.clip(1.5 * np.sin(2 * np.pi * 1.3 * t), 0, 1)
    return (x + 0.002 * random.standard_normal(len(t))).astype(np.float32)


def read_wav(path):
    with wave.open(str(path)) as w:
        assert w.getsampwidth() == 2 and w.getnchannels() == 1
        return np.frombuffer(w.readframes(w.getnframes()), "<i2") / 32768, w.getframerate()


class Definition(unittest.TestCase):
    def compare(self, x, rate, hop, **options):
        want_f0, want_strength = swipe_definition.swipe(x, rate, hop, **options)
        rows = run(x, rate, hop / rate, **options)
        self.assertEqual(rows.shape, (len(want_f0), 2))
        self.assertTrue(np.array_equal(rows[:, 0] > 0, want_f0 > 0), "voicing differs")
        voiced = want_f0 > 0
        # f0 lies on a grid, so it is the same step of it, rounded to float32.
        np.testing.assert_allclose(rows[voiced, 0], want_f0[voiced], rtol=1e-7)
        heard = want_strength > 1e-3
        np.testing.assert_allclose(rows[heard, 1], want_strength[heard], rtol=0, atol=1e-7)
        self.assertTrue((rows[~heard, 1] <= 1e-3).all())
        return voiced.mean() if len(voiced) else 0.0

    def test_voices(self):
        for seed, (rate, hop) in enumerate(
                [(8000, 80), (16000, 160), (16000, 59.2), (22050, 220.5), (44100, 441), (48000, 480),
                 (96000, 960)]):
            for mode in ("textbook", "sptk"):
                with self.subTest(rate=rate, hop=hop, mode=mode):
                    share = self.compare(voice(rate, 0.9, seed), rate, hop, mode=mode)
                    self.assertGreater(share, 0.15)

    def test_ranges(self):
        x = voice(16000, 1.0, 9)
        for low, high in [(60.0, 240.0), (100.0, 106.0), (71.0, 203.5), (25.0, 1900.0)]:
            for mode in ("textbook", "sptk"):
                with self.subTest(low=low, high=high, mode=mode):
                    self.compare(x, 16000, 160, low=low, high=high, mode=mode)

    def test_lengths(self):
        x = voice(16000, 0.5, 3)[2000:]
        for n in (1, 2, 127, 128, 129, 1023, 1024, 1025, 2048, 3001):
            for mode in ("textbook", "sptk"):
                with self.subTest(samples=n, mode=mode):
                    self.compare(x[:n], 16000, 160, mode=mode)

    def test_noise(self):
        x = np.random.default_rng(11).standard_normal(24000).astype(np.float32) * 0.1
        for mode in ("textbook", "sptk"):
            self.compare(x, 16000, 80, mode=mode)


class RealSpeech(unittest.TestCase):
    def setUp(self):
        if not DATA.is_dir():
            self.skipTest(f"{DATA} is not there: the recordings are not part of the repository")

    def test_sptk(self):
        """Periods in samples, as SPTK printed them with six digits."""
        folder = DATA / "arctic_a0007_swipe"
        x, rate = read_wav(folder / "arctic_a0007.wav")
        want = np.loadtxt(folder / "arctic_a007_p16_L60_H240_o0_swipe.txt")
        figures = {}
        for mode in ("sptk", "textbook"):
            f0 = run(x, rate, 80 / rate, 60.0, 240.0, mode)[:, 0].astype(np.float64)
            self.assertEqual(len(f0), len(want))
            got = np.where(f0 > 0, rate / np.maximum(f0, 1), 0)
            both = (got > 0) & (want > 0)
            figures[mode] = (int(((got > 0) != (want > 0)).sum()),
                             float(np.abs(got / np.maximum(want, 1) - 1)[both].max()))
            print(f"arctic_a0007, {mode}: {len(want)} rows, {int((want > 0).sum())} voiced by SPTK, "
                  f"{figures[mode][0]} voiced by one only, largest relative difference of the others "
                  f"{figures[mode][1]:.2g}")
        self.assertEqual(figures["sptk"][0], 0)
        self.assertLess(figures["sptk"][1], 7e-6)
        self.assertLess(figures["textbook"][0], 20)
        self.assertLess(figures["textbook"][1], 0.01)

    def test_definition(self):
        x, rate = read_wav(DATA / "mfa_acoustic_corpus" / "acoustic_corpus.wav")
        for mode in ("textbook", "sptk"):
            Definition.compare(self, x, rate, 160, mode=mode)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
