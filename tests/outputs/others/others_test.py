#!/usr/bin/python3
"""Exported files opened by programs of others: Blender, three.js with pixiv's VRM Animation, Khronos'
glTF validator, pandas.  `./run others` installs them; a test whose program is missing is skipped.

usage: others_test.py EXPORT_PROBE NODE_FOLDER     node_modules lies in NODE_FOLDER
"""

import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
NODE_FOLDER = pathlib.Path(sys.argv.pop(2)).resolve()
import export_test  # noqa: E402  (takes EXPORT_PROBE from the command line)

ARMS = [(side, first + begin, first + end, here, next_) for side, first in (("left", "L"), ("right", "R"))
        for begin, end, here, next_ in (("Shoulder", "Elbow", "UpperArm", "LowerArm"),
                                        ("Elbow", "Wrist", "LowerArm", "Hand"))]


def has_node(package):
    return shutil.which("node") and (NODE_FOLDER / "node_modules" / package).is_dir()


def in_node(script, path):
    shutil.copy(HERE / script, NODE_FOLDER)  # where it finds its packages
    done = subprocess.run(["node", NODE_FOLDER / script, path], stdout=subprocess.PIPE, check=True,
                          timeout=120)
    return json.loads(done.stdout)


class Others(unittest.TestCase):
    setUp, export = export_test.Export.setUp, export_test.Export.export
    figure, curves = export_test.Export.figure, export_test.Export.curves
    body, arms = staticmethod(export_test.Export.body), staticmethod(export_test.Export.arms)

    def in_blender(self, path):
        subprocess.run(["blender", "-b", "-P", HERE / "in_blender.py", "--", path, self.folder / "b.json"],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True, timeout=300)
        return json.loads((self.folder / "b.json").read_text())

    def figures(self):
        """(BVH file, its own joints' places by our reader) of a whole figure and of lifted arms."""
        joints, arms = list(range(52)), list(range(7))
        points = self.figure(joints, 20)
        points[:, :, 0] = self.rng.normal(500, 30, (20, 2))
        lifted = self.arms()[:, :2] * [[[1], [-1]]]
        for form, rate, of, values in (("bvh", 24, joints, points), ("bvh3d", 15, arms, lifted)):
            path = self.export(form, form + ".bvh", [f"rate {rate}", *self.body(of)], values)
            yield path, rate, export_test.Bvh(path).places()

    def arms_in_vrma(self):
        """A VRM Animation and where the lifted BVH of the same motion has its joints."""
        spec, points = ["rate 24", *self.body(range(7))], self.arms()[:, :2] * [[[1], [-1]]]
        places = export_test.Bvh(self.export("bvh3d", "arms.bvh", spec, points)).places()
        return self.export("vrma", "arms.vrma", spec, points), places

    def face_in_vrma(self):
        spec = ["rate 24", *(f"curve {c}" for c in export_test.CURVES)]
        return self.export("vrma", "face.vrma", spec, self.curves(30))

    @unittest.skipUnless(shutil.which("blender"), "no Blender")
    def test_blender_bvh(self):
        for path, rate, places in self.figures():
            got = self.in_blender(path)
            self.assertEqual((got["rate"], len(got["places"])), (rate, len(places["Neck"])))
            for name, want in places.items():
                have = [frame[name] for frame in got["places"]]
                np.testing.assert_allclose(have, want, atol=1e-3, err_msg=f"{path.name} {name}")

    @unittest.skipUnless(shutil.which("blender"), "no Blender")
    def test_blender_vrma(self):
        path, places = self.arms_in_vrma()
        scene = shutil.copy(path, self.folder / "arms.glb")
        got = self.in_blender(scene)["places"]  # at 24 frames a second, as Blender has it; z up
        self.assertEqual(len(got), len(places["Neck"]))
        for side, begin, end, here, next_ in ARMS:
            bone = np.array([np.subtract(frame[side + next_], frame[side + here]) for frame in got])
            bone = np.stack([bone[:, 0], bone[:, 2], -bone[:, 1]], 1)
            want = places[end] - places[begin]
            np.testing.assert_allclose(bone / np.linalg.norm(bone, axis=1, keepdims=True),
                                       want / np.linalg.norm(want, axis=1, keepdims=True), atol=1e-4)

    @unittest.skipUnless(has_node("three"), "no three.js")
    def test_three_bvh(self):
        for path, _, places in self.figures():
            got = in_node("in_three.mjs", path)
            self.assertEqual(len(got), len(places["Neck"]))
            for name, want in places.items():
                have = [frame[name] for frame in got]
                np.testing.assert_allclose(have, want, atol=5e-3, err_msg=f"{path.name} {name}")

    @unittest.skipUnless(has_node("@pixiv/three-vrm-animation"), "no three-vrm-animation")
    def test_vrm_loader(self):
        arms, face = self.arms_in_vrma()[0], self.face_in_vrma()
        for path in (arms, face):
            got, ours = in_node("in_three.mjs", path), export_test.Vrma(path)
            self.assertAlmostEqual(got["seconds"], ours.times[-1], delta=1e-6)
            have = {(n, "rotation"): v for n, v in got["rotations"].items()}
            have |= {(n, "translation"): v for n, v in got["custom"].items()}
            self.assertEqual(set(have), set(ours.tracks))
            for (name, kind), values in ours.tracks.items():
                want = values if kind == "rotation" else values[:, 0]
                np.testing.assert_allclose(have[name, kind], want.ravel(), atol=1e-5, err_msg=name)

    @unittest.skipUnless(has_node("gltf-validator"), "no glTF validator")
    def test_gltf_validator(self):
        for path in (self.arms_in_vrma()[0], self.face_in_vrma()):
            issues = in_node("in_validator.mjs", path)
            self.assertEqual((issues["numErrors"], issues["numWarnings"]), (0, 0), issues["messages"])

    @unittest.skipUnless(importlib.util.find_spec("pandas"), "no pandas")
    def test_pandas(self):
        import pandas  # pylint: disable=import-outside-toplevel
        spec, values = ["rate 24", *(f"curve {c}" for c in export_test.CURVES)], self.curves(30)
        for form, ending in (("csv", ""), ("openface", "_r"), ("openface2", "_r")):
            table = pandas.read_csv(self.export(form, form + ".csv", spec, values))
            self.assertFalse(table.isna().any(axis=None), form)
            units = table[[unit + ending for unit in export_test.CURVES[:6]]]
            np.testing.assert_allclose(units, values[:, :6], atol=6e-7, err_msg=form)
        table = pandas.read_csv(self.export("arkit", "arkit.csv", spec, values), dtype={"Timecode": str})
        np.testing.assert_allclose(table["BrowInnerUp"], values[:, 0] / 5, atol=6e-7)


if __name__ == "__main__":
    unittest.main()
