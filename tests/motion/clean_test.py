#!/usr/bin/python3
"""Cleaning against scipy.signal.medfilt and numpy.interp, resampling against numpy.interp, PATS'
columns against their definition, OpenFace's real files against Python's csv.

usage: clean_test.py MOTION_PROBE SOURCE_ROOT
"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import warnings

import numpy as np
from scipy.signal import medfilt

PROBE, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
DATA = pathlib.Path(os.environ.get("GESTUS_SHARED_DATA", ROOT / "../shared/data"))
KEPT = tempfile.TemporaryDirectory()  # until the end
FOLDER = pathlib.Path(KEPT.name)


def run(step, options, coordinates, points, rate, source):
    arguments = [step, *options, *"---"[len(options):], coordinates, points, rate, source,
                 FOLDER / "out"]
    subprocess.run([PROBE, *map(str, arguments)], check=True, timeout=60)
    return np.fromfile(FOLDER / "out", np.float32)


def run_track(step, options, values, confidence, rate=15):
    """(values, confidence) after a step; values (frames, coordinates * points)."""
    points, width = confidence.shape[1], values.shape[1]
    np.concatenate([values.ravel(), confidence.ravel()]).astype(np.float32).tofile(FOLDER / "in")
    out = run(step, options, width // points, points, rate, FOLDER / "in")
    frames = out.size // (width if step == "columns" else width + points)
    return out[:frames * width].reshape(frames, width), out[frames * width:].reshape(-1, points)


def hold_ends(x, size):
    return medfilt(np.pad(x, size // 2, mode="edge"), size)[size // 2:len(x) + size // 2]


def clean(values, confidence, size, order, least):
    """The definition: each column by itself, in float64."""
    points = confidence.shape[1]
    seen = confidence > least
    at = np.arange(len(values))
    want = values.astype(np.float64)
    for c in range(values.shape[1]):
        s = seen[:, c % points]
        if not s.any():
            continue
        x = want[:, c]
        if order == "fill":
            want[:, c] = hold_ends(np.interp(at, at[s], x[s]), size)
        else:
            y = medfilt(x, size)
            want[:, c] = np.interp(at, at[s], y[s])
    return want, np.where(seen, confidence, 0)


def random_track(rng, frames, points, coordinates, lost):
    values = (rng.normal(0, 1, (frames, coordinates * points)).cumsum(0) * 20).astype(np.float32)
    confidence = rng.uniform(0.1, 1, (frames, points)).astype(np.float32)
    confidence[rng.random((frames, points)) < lost] = 0
    gap = rng.integers(0, frames)  # in a row, often at an end
    confidence[max(0, gap - 10):gap] = 0
    confidence[rng.integers(0, frames), 0] = 1
    return values, confidence


def test_clean(rng):
    worst = 0
    for n in range(120):
        frames, points = int(rng.integers(1, 80)), int(rng.integers(1, 6))
        coordinates = 1 + n % 2
        values, confidence = random_track(rng, frames, points, coordinates, rng.random())
        size, order = [1, 3, 5, 7, 7, 7, 31, 99][n % 8], ["median", "fill"][n // 8 % 2]
        least = [0, 0, 0.3][n % 3]
        got, seen = run_track("clean", (size, order[0], least), values, confidence)
        want, want_seen = clean(values, confidence, size, order, np.float32(least))
        assert np.array_equal(seen, want_seen.astype(np.float32)), n
        worst = max(worst, np.abs(got - want).max() / max(1, np.abs(values).max()))
        assert worst <= 2e-7, (n, worst)
    return f"clean: largest error {worst:.1e} of the largest value"


def test_median_is_exact(rng):
    """Nothing is computed: the same numbers as SciPy's."""
    values = rng.normal(0, 1, (500, 9)).astype(np.float32)
    got, _ = run_track("clean", (7, "m", 0), values, np.ones((500, 9)))
    assert np.array_equal(got, np.stack([medfilt(v, 7) for v in values.T], 1))
    return "median of 7: 4500 of 4500 values equal"


def test_resample(rng):
    worst = 0
    for rate in (24, 25, 30e3 / 1001, 30, 60, 15, 12.5, 10):
        for frames in (1, 2, 3, 97, 490):
            values, confidence = random_track(rng, frames, 3, 2, 0.2)
            got, _ = run_track("resample", (15,), values, confidence, repr(float(rate)))
            times = np.arange(max(1, int(frames / rate * 15 + 1e-6))) / 15
            assert len(got) == len(times), (rate, frames)
            want = np.stack([np.interp(times, np.arange(frames) / rate, v)
                             for v in values.T.astype(np.float64)], 1)
            worst = max(worst, np.abs(got - want).max() / max(1, np.abs(values).max()))
            assert worst <= 2e-7, (rate, frames, worst)
    return f"resample: largest error {worst:.1e} of the largest value"


def test_columns(rng):
    """pose/data and pose/normalize of PATS, from absolute pixels."""
    pixels = rng.uniform(100, 1000, (50, 2, 52)).astype(np.float32)
    pixels[:, :, 1] = pixels[:, :, 0] + rng.uniform(40, 90, (50, 2))  # a shoulder of any length
    neck = pixels[:, :, :1].astype(np.float64)
    relative = pixels - neck
    scale = 167 / np.linalg.norm(relative[:, :, 1], axis=1)
    worst = 0
    for source, want in (("data", relative), ("normalize", relative * scale[:, None, None])):
        want[:, :, 0] = neck[:, :, 0]
        got, _ = run_track("columns", (source,), pixels.reshape(50, 104), np.ones((50, 52)))
        worst = max(worst, np.abs(got - want.reshape(50, 104)).max() / np.abs(want).max())
        assert worst <= 5e-7, (source, worst)
    return f"columns: largest error {worst:.1e} of the largest value"


def test_openface(_):
    if not (DATA / "facsvatar_openface").is_dir():
        return "openface: skipped, no data beside the repository (GESTUS_SHARED_DATA)"
    cells = 0
    for path in sorted((DATA / "facsvatar_openface").glob("*.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        names = [n for n in rows[0] if n.startswith("pose_R") or n.endswith("_r")]
        want = np.array([[float(row[n]) for n in names] for row in rows], np.float32)
        seen = np.repeat(np.array([[float(row["confidence"]) * (row["success"] == "1")]
                                   for row in rows], np.float32), len(names), 1)
        got = run("openface", (), "-", "-", "-", path)
        assert np.array_equal(got, np.concatenate([want.ravel(), seen.ravel()])), path
        cells += want.size
    assert cells > 0
    return f"openface: {cells} of {cells} cells equal"


def main():
    warnings.filterwarnings("ignore", "kernel_size exceeds")  # windows longer than a clip are meant
    for name, test in sorted(globals().items()):
        if name.startswith("test_"):
            print(test(np.random.default_rng(20231)))


if __name__ == "__main__":
    main()
