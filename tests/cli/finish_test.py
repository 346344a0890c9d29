"""Finishing by infer-cli against SciPy and the definitions in float64.

finish_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import json
import unittest

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import savgol_filter

from cli_harness import CliTest, golden


def fade(x, seams, frames):
    """The cubics that take the jumps out of the columns of x (frames, columns)."""
    out = x.copy()
    borders = [0, *seams, len(x)]
    for k, s in enumerate(seams):
        before, after = s - borders[k], borders[k + 2] - s
        v0 = x[s - 1] - x[s - 2] if before > 1 else None
        v1 = x[s + 1] - x[s] if after > 1 else None
        v0 = (0 * x[0] if v1 is None else v1) if v0 is None else v0
        v1 = v0 if v1 is None else v1
        jump, turn = (x[s] - v1 / 2) - (x[s - 1] + v0 / 2), v1 - v0
        for f in range(len(x)):
            distance = f - (s - 0.5)
            width = min(frames, before if distance < 0 else after)
            u = abs(distance) / width if width > 0 else 1
            if u < 1:
                h00, h10 = (1 + 2 * u) * (1 - u) ** 2, u * (1 - u) ** 2
                out[f] += -np.sign(distance) * jump / 2 * h00 - turn / 2 * width * h10
    return out


def resample(x, rate, to, linear):
    at = np.minimum(np.arange(int(len(x) * to / rate + 1e-6)) * rate / to, len(x) - 1)
    if len(x) == 1:
        return np.repeat(x, len(at), axis=0)
    if linear:
        return np.stack([np.interp(at, np.arange(len(x)), c) for c in x.T], axis=1)
    return PchipInterpolator(np.arange(len(x)), x)(at)


def smooth(x, rate, seconds):
    half = min(int(seconds * rate / 2 + 1e-6), (len(x) - 1) // 2)
    return x if half < 2 else savgol_filter(x, 2 * half + 1, 2, axis=0, mode="interp")


def jerk(x, rate, joints):
    third = np.diff(x, 3, axis=0) * rate ** 3
    points = x.shape[1] // 2
    return np.mean([np.hypot(third[:, p], third[:, points + p]) for p in joints])


class FinishTest(CliTest):

    RATE = 15

    def finish(self, weights, *options):
        """Arrays and report of a run over input.npz."""
        report = json.loads(self.good(weights, "input.npz", "-o", "out.npz", "--json", *options))
        with np.load(self.path("out.npz")) as arrays:
            return {name: arrays[name] for name in arrays.files}, report

    def tile(self, case, times):
        with np.load(golden(case + ".npz")) as arrays:
            given = {name: arrays[name] for name in arrays.files
                     if name in ("speech", "text") or name.startswith("style_")}
        rng = np.random.default_rng(7)
        for name in ("speech", "text"):
            tiled = np.tile(given[name], (times, 1))
            given[name] = (tiled + rng.normal(size=tiled.shape)).astype(np.float32)
        self.save("input.npz", given)

    def test_against_scipy(self):
        for case, times in (("frame_autoregressive", 7), ("zs_mstm2_parallel", 9), ("segment_three", 5)):
            weights = golden(case + ".fb")
            self.tile(case, times)
            raw, _ = self.finish(weights)
            self.assertNotIn("frame_rate", raw)
            info = json.loads(self.good("info", weights, "--json"))["networks"][0]["configuration"]
            window = int(info["core.frames"] if "core.frames" in info else info["frames"])
            if case == "segment_three":
                window *= int(info["context_segments"])
            for options in (["--fps", "60"], ["--fps", "24", "--linear"], ["--fps", "29.97"],
                            ["--fps", "7", "--smooth", "0.7"], ["--smooth", "0.5", "--amplitude", "1.7"],
                            ["--crossfade", "0", "--fps", "100", "--smooth", "0.2"],
                            ["--crossfade", "0.05"], ["--crossfade", "10", "--amplitude", "0.25"],
                            ["--amplitude", "0"]):
                given = dict(zip(options[::2], options[1::2])) if "--linear" not in options else {
                    "--fps": "24"}
                to = float(given.get("--fps", self.RATE))
                out, report = self.finish(weights, *options)
                self.assertAlmostEqual(float(out["frame_rate"]), to, places=5)
                self.assertEqual(report["frame_rate"], to)
                for name in {"pose", "face"} & set(raw):
                    x = raw[name].astype(np.float64)
                    scale = np.abs(x).max()
                    seams = list(range(window, len(x), window))
                    x = fade(x, seams, float(given.get("--crossfade", 0.3)) * self.RATE)
                    rest, neck = np.median(x, axis=0), x.copy()
                    x = rest + float(given.get("--amplitude", 1)) * (x - rest)
                    if name == "pose":  # the neck's columns are its position in the picture
                        for column in (0, x.shape[1] // 2):
                            x[:, column] = neck[:, column]
                    seconds, linear = float(given.get("--smooth", 0)), "--linear" in options
                    if to < self.RATE:
                        x = resample(smooth(x, self.RATE, seconds), self.RATE, to, linear)
                    else:
                        x = smooth(resample(x, self.RATE, to, linear), to, seconds)
                    self.assertEqual(out[name].shape, x.shape)
                    self.assertEqual(report["frames"], len(x))
                    np.testing.assert_allclose(out[name], x, rtol=0, atol=4e-6 * scale, err_msg=options)
                    self.check_jerk(name, raw[name], out[name], to, linear, report["finish"])

    def check_jerk(self, name, raw, out, rate, linear, report):
        part = "body" if name == "pose" else "face"
        joints = range(1 if name == "pose" else 0, raw.shape[1] // 2)
        after = resample(out.astype(np.float64), rate, self.RATE, False)
        for key, x in (("jerk_before", raw.astype(np.float64)), ("jerk_after", after)):
            told = [j for j in report[key] if j["part"] == part]
            self.assertEqual(told[0]["unit"], "shoulder lengths/s^3")
            self.assertAlmostEqual(told[0]["value"], jerk(x, self.RATE, joints) / 167,
                                   delta=1e-3 * np.abs(raw).max())

    def test_nothing_asked_nothing_touched(self):
        self.good(self.WEIGHTS, "input.npz", "-o", "a.npz")
        self.good(self.WEIGHTS, "input.npz", "-o", "b.npz", "--json")
        self.good(self.WEIGHTS, "input.npz", "-o", "c.npz", "--crossfade", "0", "--amplitude", "1")
        files = self.snapshot()
        self.assertEqual(files["a.npz"], files["b.npz"])
        with np.load(self.path("a.npz")) as a, np.load(self.path("c.npz")) as c:
            np.testing.assert_array_equal(a["pose"], c["pose"])
        self.assertIn("jerk", self.good(self.WEIGHTS, "input.npz", "--fps", "30"))

    def test_action_units(self):
        for case in ("model1_sequence", "model2_text"):
            with np.load(golden(case + ".npz")) as arrays:
                self.save("input.npz", {n: arrays[n] for n in ("f0", "text") if n in arrays.files})
            weights = golden(case + ".fb")
            raw, _ = self.finish(weights)
            out, report = self.finish(weights, "--fps", "48", "--amplitude", "10")
            np.testing.assert_array_equal(raw["tokens"], out["tokens"])
            channels = raw["face"].shape[2]
            self.assertEqual(out["face"].shape, (report["frames"], channels))
            self.assertEqual(report["frame_rate"], 48)
            network = json.loads(self.good("info", weights, "--json"))["networks"][0]
            self.assertTrue(np.isfinite(out["face"]).all(), network["kind"])

    def test_bad_options(self):
        for options, says in ((("--fps", "0"), "--fps"), (("--fps", "nan"), "frame rate: is nan, expected 1 to 1000"),
                              (("--fps", "1e9"), "--fps"), (("--crossfade", "-1"), "--crossfade"),
                              (("--smooth", "11"), "--smooth"), (("--amplitude", "-0.1"), "--amplitude"),
                              (("--amplitude", "inf"), "--amplitude")):
            self.bad(self.WEIGHTS, "input.npz", "-o", "o.npz", *options, says=(says,))
        with np.load(golden("ast_cls.npz")) as arrays:
            self.save("speech.npz", {"speech": arrays["speech"]})
        self.bad(self.AST_WEIGHTS, "speech.npz", "-o", "o.npz", "--fps", "30",
                 says=("makes no motion", "expected a gesture network"))


if __name__ == "__main__":
    unittest.main()
