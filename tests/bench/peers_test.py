"""Runs bench/peers on its smallest network: agreeing engines get times, others get none.

usage: peers_test.py SOURCE_ROOT PROGRAMS
"""
import importlib.util
import json
import pathlib
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
from bench.peers import workers  # noqa: E402

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
    def run_bench(cls, *engines):
        return main(["--folder", str(cls.folder), "--programs", str(PROGRAMS), "--cases", CASE,
                     "--rounds", "2", "--starts", "1", "--threads", "1",
                     "--page", str(cls.folder / "page.md"), "--chart", str(cls.folder / "chart.svg"),
                     "--engines", *engines])

    @classmethod
    def results(cls):
        [case] = json.loads((cls.folder / "results.json").read_text())["cases"]
        return {result["engine"]: result for result in case["results"]}

    @classmethod
    def count_bars(cls):
        tree = xml.etree.ElementTree.parse(cls.folder / "chart.svg")
        return sum(float(bar.get("height")) > 12 and bar.get("class") in ("gestus", "ort", "torch")
                   for bar in tree.iter(SVG + "rect"))

    def refused_by_gestus(self, reason):
        """After what a test has damaged: no time, no bar, a status, and the reason on the page."""
        self.assertEqual(self.run_bench("gestus"), 1)
        result = self.results()["gestus"]
        self.assertIn(reason, result["failed"])
        self.assertEqual(result["threads"], {})
        self.assertIn(reason, (self.folder / "page.md").read_text())
        self.assertEqual(self.count_bars(), 0)

    def test_engines_that_agree_get_times(self):
        self.assertEqual(self.status, 0)
        for title in ("gestus", "PyTorch"):
            rows = [line for line in self.page.splitlines() if f"| {title} | fp32 | 0." in line]
            self.assertEqual(len(rows), 1, self.page)
        self.assertIn("not asked for", self.page)  # ONNX Runtime
        self.assertEqual(self.bars, 2)

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

    def test_other_types_run_where_their_files_are(self):
        path = self.folder / CASE / "gestus.bf16.fb"
        try:
            path.write_bytes((self.folder / CASE / "gestus.fp32.fb").read_bytes())
            self.assertEqual(self.run_bench("gestus"), 0)
            self.assertRegex((self.folder / "page.md").read_text(), r"\| gestus \| bf16 \| 0\.")
        finally:
            path.unlink()

    def test_cores_are_different(self):
        self.assertEqual(len(set(workers.cores(2))), len(workers.cores(2)))
        self.assertEqual(workers.cores(1), workers.cores(2)[:1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
