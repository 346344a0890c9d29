"""Runs bench/peers on its smallest network in all types: agreeing engines get times, others get none.

usage: peers_test.py SOURCE_ROOT PROGRAMS
"""
import importlib.util
import json
import pathlib
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from unittest import mock

SKIPPED = 77
if any(importlib.util.find_spec(name) is None for name in ("numpy", "torch")):
    print("skipped: python3-numpy or python3-torch is not installed")
    sys.exit(SKIPPED)

ROOT, PROGRAMS = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
sys.path.insert(0, str(ROOT))

# pylint: disable=wrong-import-position
import numpy as np  # noqa: E402
from bench.peers.__main__ import main  # noqa: E402
from bench.peers import measure, workers  # noqa: E402

CASE = "lstm64"
SVG = "{http://www.w3.org/2000/svg}"


class PeersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.holder.name)
        cls.status = cls.run_bench("gestus", "torch")
        cls.page = (cls.folder / "page.md").read_text()
        cls.bars = cls.count_bars()

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @classmethod
    def run_bench(cls, *engines, types=workers.TYPES):
        return main(["--folder", str(cls.folder), "--programs", str(PROGRAMS), "--cases", CASE,
                     "--rounds", "2", "--starts", "1", "--threads", "1",
                     "--page", str(cls.folder / "page.md"), "--chart", str(cls.folder / "chart.svg"),
                     "--engines", *engines, "--types", *types])

    @classmethod
    def results(cls):
        [case] = json.loads((cls.folder / "results.json").read_text())["cases"]
        return {(result["engine"], result["type"]): result for result in case["results"]}

    @classmethod
    def count_bars(cls):
        tree = xml.etree.ElementTree.parse(cls.folder / "chart.svg")
        kinds = {f"{engine} {kind}" for engine in ("gestus", "ort", "torch") for kind in workers.TYPES}
        return sum(bar.get("class") in kinds for bar in tree.iter(SVG + "rect"))

    def refused_by_gestus(self, reason):
        """After what a test has damaged: no time, no bar, a status, and the reason on the page."""
        self.assertEqual(self.run_bench("gestus", types=["fp32"]), 1)
        result = self.results()["gestus", "fp32"]
        self.assertIn(reason, result["failed"])
        self.assertEqual(result["threads"], {})
        self.assertIn(reason, (self.folder / "page.md").read_text())
        self.assertEqual(self.count_bars(), 0)

    def test_engines_that_agree_get_times(self):
        self.assertEqual(self.status, 0)
        for title in ("gestus", "PyTorch"):
            for kind in workers.TYPES:
                rows = [x for x in self.page.splitlines() if re.search(rf"\| {title} \| {kind} \| \d", x)]
                self.assertEqual(len(rows), 1, self.page)
        self.assertIn("not asked for", self.page)  # ONNX Runtime
        self.assertEqual(self.bars, 2 * len(workers.TYPES))

    def test_narrow_files_are_small(self):
        """An element of bf16 takes half, of int8 a quarter of float32's bytes."""
        for name in ("gestus.{}.fb", "torch.{}.pt"):
            size = {kind: (self.folder / CASE / name.format(kind)).stat().st_size
                    for kind in workers.TYPES}
            self.assertLess(size["bf16"], 0.55 * size["fp32"])
            self.assertLess(size["int8"], 0.35 * size["fp32"])

    def test_a_narrow_type_has_its_own_peak(self):
        with workers.Peak(PROGRAMS) as peak:
            gops = peak.gops()
            self.assertGreater(gops["fp32"], 0)
            for kind in workers.NARROW:
                if kind in peak.instructions:
                    self.assertGreater(gops[kind], gops["fp32"])
                else:
                    self.assertEqual(gops[kind], gops["fp32"])

    def test_long_runs_have_fewer_rounds(self):
        seconds = measure._round_seconds({"slow": 30.0, "failed": float("inf")})
        self.assertAlmostEqual(seconds, 30 + measure.SETTLE_SECONDS)

    def test_work_is_counted(self):
        flops = json.loads((self.folder / CASE / "case.json").read_text())["flops"]
        steps, width, layers = 16, 64, 3
        self.assertEqual(flops, layers * steps * 2 * 4 * width * (width + width))

    def test_an_output_that_differs_gets_no_time(self):
        path = self.folder / CASE / "expected.bin"
        right = path.read_bytes()
        wrong = np.frombuffer(right, np.float32).copy()
        wrong[-1] += 0.001 * np.abs(wrong).max()
        try:
            path.write_bytes(wrong.tobytes())
            self.refused_by_gestus("output differs")
        finally:
            path.write_bytes(right)

    def test_a_worker_that_ends_gets_no_time(self):
        path = self.folder / CASE / "gestus.fp32.fb"
        right = path.read_bytes()
        try:
            path.write_bytes(right[:1000])
            self.refused_by_gestus("exit 1")
        finally:
            path.write_bytes(right)

    def test_a_worker_that_dies_later_gets_no_time(self):
        run, runs = workers.Worker.run, []

        def dies_later(worker, count):
            runs.append(count)
            if len(runs) == 3:
                worker.process.kill()
            return run(worker, count)

        with mock.patch.object(workers.Worker, "run", dies_later):
            self.refused_by_gestus("exit -9")

    def test_cores_are_different(self):
        self.assertEqual(len(set(workers.cores(2))), len(workers.cores(2)))
        self.assertEqual(workers.cores(1), workers.cores(2)[:1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
