"""Runs the programs of bench/scale on the smallest networks, and compares the line of agents with one
that is followed event by event.

usage: scale_test.py SOURCE_ROOT PROGRAMS
"""
import importlib.util
import pathlib
import sys
import unittest

SKIPPED = 77
if importlib.util.find_spec("numpy") is None:
    print("skipped: python3-numpy is not installed")
    sys.exit(SKIPPED)

ROOT, PROGRAMS = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
sys.path.insert(0, str(ROOT))

# pylint: disable=wrong-import-position
import numpy as np  # noqa: E402
from bench.scale import line, measure, page  # noqa: E402

GOLDENS = ROOT / "tests" / "goldens"


def step_by_step(arrivals, taken):
    """When a worker ends each, by asking of every arrival whether it is still busy."""
    free, result = 0.0, []
    for arrival, service in zip(arrivals, taken):
        free = max(free, arrival) + service
        result.append(free - arrival)
    return result


class LineTest(unittest.TestCase):
    def test_waits_as_a_queue_does(self):
        random = np.random.default_rng(3)
        arrivals = np.sort(random.uniform(0, 10, 500))
        taken = random.uniform(0.001, 0.03, 500)
        np.testing.assert_allclose(line._wait(arrivals, taken), step_by_step(arrivals, taken),
                                   atol=1e-9)

    def test_agents_spread_evenly_never_wait(self):
        times = line.completions([0.02], 100, 4.0, spread=True)
        np.testing.assert_allclose(times, 0.02, atol=1e-9)

    def test_most_agents(self):
        self.assertEqual(line.most_agents([0.02], 4.0, 0.0201, spread=True), 200)
        self.assertEqual(line.most_agents([0.02], 4.0, 0.01, spread=False), 0)
        some = line.most_agents([0.02], 4.0, 0.1, spread=False)
        self.assertTrue(0 < some < 200, some)


class ProgramsTest(unittest.TestCase):
    def test_cold_start(self):
        said = [measure.cold_start(PROGRAMS, GOLDENS / "ast_cls.fb", residence, threads, 1)
                for residence, threads in (("mapped", 1), ("copied", 1), ("copied", 2))]
        self.assertEqual(len({one["output"] for one in said}), 1, said)
        self.assertTrue(all(one["start_ms"] > 0 and one["resident_mb"] > 1 for one in said))

    def test_due(self):
        with measure.hogs(1):
            times = measure.due(PROGRAMS, GOLDENS / "ast_cls.fb", 0.002, 50)
        self.assertEqual(len(times), 50)
        self.assertTrue(all(time > 0 for time in times))

    def test_batches(self):
        said = measure.batches(PROGRAMS, GOLDENS / "ast_cls.fb", 1, 3)
        self.assertEqual(list(said), ["1", "2", "4", "8"])


class PageTest(unittest.TestCase):
    def test_says_that_others_were_busy(self):
        batch = [{"type": "int8", "threads": 1, "ms": {"1": 2.0, "2": 1.8, "4": 1.7, "8": 1.6}}]
        busy, quiet = (page.render({"machine": "a machine",
                                    "batch": {"date": "today", "busy": share, "found": batch}})
                       for share in (0.5, 0.0))
        self.assertIn("25%", busy)
        self.assertIn("Others took up to 50%", busy)
        self.assertNotIn("Others", quiet)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
