"""infer-cli writing motion in the formats of others, in a run and afterwards.

usage: cli_export_test.py INFER_CLI GOLDENS
"""

import csv
import json
import os
import unittest

import numpy as np
from cli_harness import CliTest, golden

FACE = golden("model2_released.fb")


class ExportTest(CliTest):
    def face_run(self, *arguments):
        with np.load(golden("model2_released.npz")) as arrays:
            self.save("face.npz", {name: arrays[name] for name in ("f0", "text")})
        return self.good(FACE, "face.npz", "-o", "motion.npz", *arguments)

    def table(self, name):
        with open(self.path(name), newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        return header, np.array(rows, np.float64)

    def test_in_a_run(self):
        said = self.good(self.WEIGHTS, "input.npz", "-o", "m.npz", "--export", "csv=m.csv", "--export",
                         "bvh=m.bvh", "--export=openpose=poses/", "--export", "bvh3d=3.bvh")
        for line in ("wrote  csv: m.csv\n", "wrote  openpose: poses/\n"):
            self.assertIn(line, said)
        pose = self.expected["pose"]
        header, rows = self.table("m.csv")
        self.assertEqual((header[0], rows.shape), ("time", (len(pose), 1 + pose.shape[1])))
        with np.load(self.path("m.npz")) as arrays:
            self.assertTrue(np.array_equal(rows[:, 1:].astype(np.float32), arrays["pose"]))
        self.assertEqual(len(os.listdir(self.path("poses"))), len(pose))
        with open(self.path("m.bvh"), encoding="ascii") as file:
            self.assertIn(f"Frames: {len(pose)}\nFrame Time: 0.06666666666666667\n", file.read())

    def test_afterwards_it_is_the_same(self):
        kinds = ["openface", "openface2", "csv", "arkit", "vrm", "vrma", "fap", "bap"]
        self.face_run(*(f"--export={k}={k}.a" for k in kinds))
        said = json.loads(self.good("export", FACE, "motion.npz", "--json",
                                    *(f"--export={k}={k}.b" for k in kinds)))
        self.assertEqual(said["exports"], [f"{k}: {k}.b" for k in kinds])
        for kind in kinds:
            texts = []
            for run in "ab":
                with open(self.path(f"{kind}.{run}"), "rb") as file:
                    texts.append(file.read())
            self.assertEqual(*texts, kind)

    def test_options(self):
        self.face_run("--export", "openface=whole.csv")
        self.good("export", FACE, "motion.npz", "--halve", "--export", "openface=half.csv")
        whole, half = self.table("whole.csv")[1], self.table("half.csv")[1]
        np.testing.assert_allclose(half[:, 1:], whole[:, 1:] / 2, atol=1e-6)
        self.good(self.WEIGHTS, "input.npz", "-o", "m.npz", "--stance", "100,50.5,20", "--export",
                  "openpose=poses")
        with open(self.path("poses/poses_000000000000_keypoints.json"), encoding="ascii") as file:
            person, = json.load(file)["people"]
        self.assertEqual(person["pose_keypoints_2d"][3:6], [100, 50.5, 1])

    def test_finished_motion(self):
        """Motion at a rate of its own: frame_rate beside it, curves as (frames, curves)."""
        values = np.linspace(0, 1, 3 * 60, dtype=np.float32).reshape(60, 3)
        self.save("done.npz", {"face": values, "frame_rate": np.float32(60)})
        self.good("export", FACE, "done.npz", "--export", "csv=done.csv")
        rows = self.table("done.csv")[1]
        np.testing.assert_allclose(rows[:, 0], np.arange(60) / 60, atol=1e-6)
        self.assertTrue(np.array_equal(rows[:, 1:].astype(np.float32), values))
        self.save("done.npz", {"pose": self.expected["pose"], "frame_rate": np.float32(30)})
        self.good("export", self.WEIGHTS, "done.npz", "--export", "bvh=done.bvh")
        with open(self.path("done.bvh"), encoding="ascii") as file:
            self.assertIn("Frame Time: 0.03333333333333333\n", file.read())
        for rate in (0, -1, np.inf, [1, 2]):
            self.save("bad.npz", {"face": values, "frame_rate": np.float32(rate)})
            self.bad("export", FACE, "bad.npz", "--export", "csv=bad.csv", says=["frame_rate"])

    def test_refusals(self):
        self.face_run()
        self.bad("export", FACE, "motion.npz", says=["--export is required"])
        self.bad("export", FACE, "motion.npz", "--export", "bvh", says=["expected FORMAT=PATH"])
        self.bad("export", FACE, "motion.npz", "--export", "bvh=", says=["expected FORMAT=PATH"])
        self.bad("export", FACE, "motion.npz", "--export", "mov=x", says=["\"mov\" is unknown", "bvh3d"])
        self.bad("export", FACE, "motion.npz", "--export", "bvh=x", says=["x: the motion has no body"])
        self.bad("export", FACE, "input.npz", "--export", "csv=x", says=["has no pose and no face"])
        self.bad("export", FACE, "none.npz", "--export", "csv=x", says=["none.npz: cannot be opened"])
        self.bad("export", FACE, "motion.npz", "--export", "csv=no/x", says=["no/x: cannot be written"])
        self.bad("export", FACE, "motion.npz", "--network", "nobody", "--export", "csv=x",
                 says=["no network nobody"])
        self.bad("export", self.WEIGHTS, "motion.npz", "--export", "csv=x", says=["pose: does not fit"])
        self.bad("export", self.AST_WEIGHTS, "motion.npz", "--export", "csv=x", says=["makes no motion"])
        self.bad("export", FACE, "motion.npz", "--stance", "1,2", "--export", "csv=x", says=["--stance"])
        self.bad("export", FACE, "motion.npz", "--stance", "1,2,0", "--export", "csv=x", says=["stance"])
        self.bad(self.WEIGHTS, "input.npz", "--export", "mov=x", says=["\"mov\" is unknown"])

    def test_nothing_is_left_where_one_format_does_not_suit(self):
        """Told before the network runs, and before the first of several files."""
        self.face_run()
        self.bad(self.WEIGHTS, "input.npz", "-o", "m.npz", "--html", "m.html", "--export", "bvh=m.bvh",
                 "--export", "arkit=m.csv", says=["m.csv: the motion has no action units"])
        self.bad("export", FACE, "motion.npz", "--export", "csv=m.csv", "--export", "bvh=m.bvh",
                 says=["m.bvh: the motion has no body"])
        self.bad(self.AST_WEIGHTS, "input.npz", "--export", "csv=m.csv", says=["makes no motion"])

    def test_two_outputs_of_one_path(self):
        self.face_run()
        for outputs in (("--export", "csv=m", "--export", "fap=m"), ("--export", "csv=./m", "--export", "bap=m/")):
            self.bad("export", FACE, "motion.npz", *outputs, says=["m", "named for two outputs"])
        for outputs in (("--html", "m.npz"), ("--export", "csv=x/../m.npz"), ("--svg", "p", "--mp4", "p")):
            self.bad(self.WEIGHTS, "input.npz", "-o", "m.npz", *outputs, says=["named for two outputs"])
        self.bad(self.WEIGHTS, "input.npz", "-o", "m.npz", "--svg", "./input.npz", says=["an input and an output"])
        self.bad("export", FACE, "motion.npz", "--export", "csv=motion.npz", says=["an input and an output"])


if __name__ == "__main__":
    unittest.main()
