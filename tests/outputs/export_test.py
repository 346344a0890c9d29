#!/usr/bin/python3
"""What gestus exports, opened by others: Python's json and csv, assimp (BVH), and readers written here
from the formats' descriptions (BVH, Greta's FAP and BAP).

usage: export_test.py EXPORT_PROBE
"""

import csv
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PROBE = pathlib.Path(sys.argv.pop(1)).resolve()
NAMES = ["Neck", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist", "Nose", "REye",
         "LEye", "LHandRoot", *(f"LHand{i}" for i in range(20)), "RHandRoot",
         *(f"RHand{i}" for i in range(20))]
PARENTS = [-1, 0, 1, 2, 0, 4, 5, 0, 7, 7, 6, 10, 11, 12, 13, 10, 15, 16, 17, 10, 19, 20, 21, 10, 23, 24,
           25, 10, 27, 28, 29, 3, 31, 32, 33, 34, 31, 36, 37, 38, 31, 40, 41, 42, 31, 44, 45, 46, 31, 48,
           49, 50]
LANDMARKS = [0, 4, 8, 12, 16, 17, 19, 21, 22, 24, 26, 37, 41, 44, 46]
AUTHOR = ("timestamp gaze_0_x gaze_0_y gaze_0_z gaze_1_x gaze_1_y gaze_1_z gaze_angle_x gaze_angle_y "
          "pose_Tx pose_Ty pose_Tz pose_Rx pose_Ry pose_Rz AU01_r AU02_r AU04_r AU05_r AU06_r AU07_r "
          "AU09_r AU10_r AU12_r AU14_r AU15_r AU17_r AU20_r AU23_r AU25_r AU26_r AU45_r").split()
CURVES = ["AU01", "AU02", "AU04", "AU05", "AU06", "AU07", "Rx", "Ry", "Rz"]
# Live Link Face's header, from recordings of others.
LIVE_LINK = (
    "Timecode,BlendshapeCount,EyeBlinkLeft,EyeLookDownLeft,EyeLookInLeft,EyeLookOutLeft,EyeLookUpLeft,"
    "EyeSquintLeft,EyeWideLeft,EyeBlinkRight,EyeLookDownRight,EyeLookInRight,EyeLookOutRight,"
    "EyeLookUpRight,EyeSquintRight,EyeWideRight,JawForward,JawRight,JawLeft,JawOpen,MouthClose,"
    "MouthFunnel,MouthPucker,MouthRight,MouthLeft,MouthSmileLeft,MouthSmileRight,MouthFrownLeft,"
    "MouthFrownRight,MouthDimpleLeft,MouthDimpleRight,MouthStretchLeft,MouthStretchRight,MouthRollLower,"
    "MouthRollUpper,MouthShrugLower,MouthShrugUpper,MouthPressLeft,MouthPressRight,MouthLowerDownLeft,"
    "MouthLowerDownRight,MouthUpperUpLeft,MouthUpperUpRight,BrowDownLeft,BrowDownRight,BrowInnerUp,"
    "BrowOuterUpLeft,BrowOuterUpRight,CheekPuff,CheekSquintLeft,CheekSquintRight,NoseSneerLeft,"
    "NoseSneerRight,TongueOut,HeadYaw,HeadPitch,HeadRoll,LeftEyeYaw,LeftEyePitch,LeftEyeRoll,RightEyeYaw,"
    "RightEyePitch,RightEyeRoll").split(",")
SHAPES_OF = {1: ["BrowInnerUp"], 2: ["BrowOuterUpLeft", "BrowOuterUpRight"],
             4: ["BrowDownLeft", "BrowDownRight"], 5: ["EyeWideLeft", "EyeWideRight"],
             6: ["CheekSquintLeft", "CheekSquintRight"], 7: ["EyeSquintLeft", "EyeSquintRight"]}


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array({"X": [[1, 0, 0], [0, c, -s], [0, s, c]],
                     "Y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                     "Z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis])


def matrix_of(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Bvh:
    """Reads a BVH file and computes where its joints are."""

    def __init__(self, path):
        words = iter(pathlib.Path(path).read_text(encoding="ascii").split())
        assert next(words) == "HIERARCHY" and next(words) == "ROOT"
        self.joints, self.offsets, self.parents, self.channels = [], [], [], []
        self.read_joint(words, -1)
        assert [next(words), next(words)] == ["MOTION", "Frames:"]
        self.frames = int(next(words))
        assert [next(words), next(words)] == ["Frame", "Time:"]
        self.frame_time = float(next(words))
        self.values = np.array([float(w) for w in words]).reshape(self.frames, -1)
        assert self.values.shape[1] == sum(map(len, self.channels))
        assert np.isfinite(self.values).all()

    def read_joint(self, words, parent):
        self.joints.append(next(words))
        assert [next(words), next(words)] == ["{", "OFFSET"]
        self.offsets.append(np.array([float(next(words)) for _ in range(3)]))
        self.parents.append(parent)
        assert next(words) == "CHANNELS"
        self.channels.append([next(words) for _ in range(int(next(words)))])
        index = len(self.joints) - 1
        while (word := next(words)) != "}":
            if word == "JOINT":
                self.read_joint(words, index)
            else:
                assert [word, next(words), next(words), next(words)] == ["End", "Site", "{", "OFFSET"]
                [float(next(words)) for _ in range(3)]
                assert next(words) == "}"

    def places(self):
        """{joint: (frames, 3)}."""
        result = {name: np.zeros((self.frames, 3)) for name in self.joints}
        for frame in range(self.frames):
            values = iter(self.values[frame])
            turns, places = [], []
            for name, offset, parent, channels in zip(self.joints, self.offsets, self.parents,
                                                      self.channels):
                own, place = np.eye(3), offset.copy()
                for channel in channels:
                    value = next(values)
                    if channel.endswith("position"):
                        place["XYZ".index(channel[0])] += value
                    else:
                        own = own @ turn(channel[0], np.radians(value))
                if parent >= 0:
                    place = places[parent] + turns[parent] @ place
                    own = turns[parent] @ own
                places.append(place)
                turns.append(own)
                result[name][frame] = place
        return result


def assimp_places(path, folder):
    """{node: (frames, 3)} as assimp understands the file, and its frames a second."""
    made = pathlib.Path(folder) / "scene.json"
    subprocess.run(["assimp", "export", str(path), str(made), "-fassjson"], check=True, timeout=60,
                   stdout=subprocess.DEVNULL)
    scene = json.loads(made.read_text(encoding="utf-8"))
    animation, = scene["animations"]
    channels = {c["name"]: c for c in animation["channels"]}
    frames = max(len(c["rotationkeys"]) for c in channels.values())
    result = {}

    def walk(node, above):
        channel, transforms = channels.get(node["name"]), []
        fixed = np.array(node["transformation"], float).reshape(4, 4)
        for frame in range(frames):
            own = fixed.copy()
            if channel:
                keys = channel["rotationkeys"], channel["positionkeys"]
                rotation, position = (k[min(frame, len(k) - 1)][1] for k in keys)
                own[:3, :3], own[:3, 3] = matrix_of(*rotation), position
            transforms.append(above[frame] @ own)
        result[node["name"]] = np.array([t[:3, 3] for t in transforms])
        for child in node.get("children", []):
            walk(child, transforms)

    walk(scene["rootnode"], [np.eye(4)] * frames)
    return result, animation["tickspersecond"]


class Vrma:
    """Reads a binary glTF with the extension VRMC_vrm_animation."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        assert data[:4] == b"glTF" and struct.unpack_from("<II", data, 4) == (2, len(data))
        length, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON" and length % 4 == 0
        self.json = json.loads(data[20:20 + length])
        size, kind = struct.unpack_from("<I4s", data, 20 + length)
        self.binary = data[28 + length:]
        assert kind == b"BIN\0" and size == len(self.binary) == self.json["buffers"][0]["byteLength"]
        meaning = self.json["extensions"]["VRMC_vrm_animation"]
        assert meaning["specVersion"] == "1.0"
        self.nodes = {name: bone["node"] for name, bone in
                      [*meaning["humanoid"]["humanBones"].items(), *meaning["expressions"]["custom"].items()]}
        self.tracks = {}
        animation, = self.json["animations"]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            self.times = self.accessor(sampler["input"])[:, 0]
            name = next(n for n, i in self.nodes.items() if i == channel["target"]["node"])
            self.tracks[name, channel["target"]["path"]] = self.accessor(sampler["output"])

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        assert accessor["componentType"] == 5126
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        values = np.frombuffer(self.binary, "<f4", accessor["count"] * width, view["byteOffset"])
        assert values.nbytes == view["byteLength"]
        if "max" in accessor:
            assert accessor["min"] == [values.min()] and np.float32(accessor["max"][0]) == values.max()
        return values.reshape(-1, width).astype(np.float64)

    def turned(self, bone, vector):
        """(frames, 3): `vector` turned by the rotation of `bone`."""
        return np.array([matrix_of(w, x, y, z) @ vector for x, y, z, w in self.tracks[bone, "rotation"]])


def assimp_rotations(path, folder):
    """{node: (frames, 4), x y z w} of a glTF, as assimp understands it."""
    shutil.copy(path, pathlib.Path(folder) / "scene.glb")
    made = pathlib.Path(folder) / "scene.json"
    subprocess.run(["assimp", "export", str(pathlib.Path(folder) / "scene.glb"), str(made), "-fassjson"],
                   check=True, timeout=60, stdout=subprocess.DEVNULL)
    animation, = json.loads(made.read_text(encoding="utf-8"))["animations"]
    return {c["name"]: np.array([[*k[1][1:], k[1][0]] for k in c["rotationkeys"]])
            for c in animation["channels"]}


def read_greta(path, parameters):
    """(name, fps, masks (frames, parameters), values likewise) of a FAP or BAP file."""
    lines = pathlib.Path(path).read_text(encoding="ascii").splitlines()
    version, name, fps, count = lines[0].split(" ")
    assert version == "2.1" and len(lines) == 1 + 2 * int(count)
    masks = np.zeros((int(count), parameters + 1), int)
    values = np.zeros((int(count), parameters + 1), int)
    for frame in range(int(count)):
        flags = [int(w) for w in lines[1 + 2 * frame].split()]
        number, *given = [int(w) for w in lines[2 + 2 * frame].split()]
        assert number == frame and len(flags) == parameters and set(flags) <= {0, 1}
        assert len(given) == sum(flags)
        masks[frame, 1:] = flags
        values[frame, np.flatnonzero(masks[frame])] = given
    return name, float(fps), masks, values


def greta_joint(frame, flexion, twisting, abduct):
    """The turn of a joint of Greta's, from the BAPs of its axes x, y and z."""
    x, y, z = frame[[flexion, twisting, abduct]] / 1e5
    return turn("Z", z) @ turn("Y", y) @ turn("X", x)


class Export(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.rng = np.random.default_rng(7)

    def export(self, form, out, spec, *values):
        (self.folder / "spec").write_text("\n".join(spec) + "\n", encoding="utf-8")
        np.concatenate([np.asarray(v, np.float32).ravel() for v in values]).tofile(self.folder / "in")
        done = subprocess.run([PROBE, form, self.folder / "spec", self.folder / "in", self.folder / out],
                              stderr=subprocess.PIPE, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return self.folder / out

    @staticmethod
    def body(joints):
        index = {j: i for i, j in enumerate(joints)}
        return [f"body {NAMES[j]} {index.get(PARENTS[j], -1)} {j}" for j in joints]

    def curves(self, frames):
        return np.concatenate([self.rng.uniform(0, 5, (frames, 6)),
                               self.rng.uniform(-0.6, 0.6, (frames, 3))], 1).astype(np.float32)

    def figure(self, joints, frames, bones=None):
        """Points (frames, 2, joints) with bones of fixed length, y down; and their pixels' scale."""
        points = np.zeros((frames, 2, 52))
        turns = self.rng.normal(0, 0.15, (frames, 52)).cumsum(0) + self.rng.uniform(-3, 3, 52)
        for j in range(1, 52):
            length = 167 if j in (1, 4) else 20 + 5 * j
            points[:, 0, j] = points[:, 0, PARENTS[j]] + length * np.cos(turns[:, j])
            points[:, 1, j] = points[:, 1, PARENTS[j]] + length * np.sin(turns[:, j])
        return points[:, :, joints].astype(np.float32)

    def test_openpose(self):
        for joints, face in ((range(11), []), (range(52), LANDMARKS), ([1, 2, 3], [])):
            joints = list(joints)
            points = self.figure(joints, 3)
            marks = self.rng.normal(0, 50, (3, 2, len(face))).astype(np.float32)
            stances = [(300.5 + i, 200, 80 + i) for i in range(3)]
            spec = ["name wave", *self.body(joints), *(f"face F {-1} {i}" for i in face),
                    *(f"stance {x} {y} {s}" for x, y, s in stances)]
            out = self.export("openpose", f"clip{len(joints)}", spec, points, marks)
            self.assertEqual(sorted(os.listdir(out)),
                             [f"wave_{i:012d}_keypoints.json" for i in range(3)])
            for i, path in enumerate(sorted(out.iterdir())):
                person, = json.loads(path.read_text(encoding="utf-8"))["people"]
                x, y, shoulder = stances[i]
                got = {k: np.array(v).reshape(-1, 3) for k, v in person.items() if k.endswith("_2d")}
                want = {k: np.zeros_like(v) for k, v in got.items()}
                body = [1, 2, 3, 4, 5, 6, 7, 0, 15, 16]  # of PATS' joints 0 to 9 in BODY_25
                want["pose_keypoints_2d"][1] = x, y, 1
                for column, joint in enumerate(joints):
                    point = points[i, :, column] * shoulder / 167 + [x, y] if joint else [x, y]
                    field, at = (("pose", body[joint]) if joint < 10 else
                                 ("hand_left", joint - 10) if joint < 31 else ("hand_right", joint - 31))
                    want[field + "_keypoints_2d"][at] = *point, 1
                for column, mark in enumerate(face):
                    want["face_keypoints_2d"][mark] = *(marks[i, :, column] * shoulder / 167 + [x, y]), 1
                self.assertEqual(len(got["pose_keypoints_2d"]), 25)
                self.assertEqual(len(got["face_keypoints_2d"]), 70 if face else 0)
                self.assertEqual(len(got["hand_left_keypoints_2d"]), 21 if 10 in joints else 0)
                for field, points_of in want.items():
                    np.testing.assert_allclose(got[field], points_of, atol=6e-4, err_msg=field)

    def test_openface(self):
        values = self.curves(50)
        for name, halve, first in (("openface", False, []), ("openface", True, []),
                                   ("openface2", False, ["frame", "face_id", "timestamp", "confidence",
                                                         "success"])):
            out = self.export(name, "face.csv",
                              ["rate 24", *(f"curve {c}" for c in CURVES), *(["halve"] * halve)], values)
            with open(out, newline="", encoding="ascii") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(list(rows[0]), first + AUTHOR[1 if first else 0:])
            self.assertEqual(len(rows), 50)
            for i, row in enumerate(rows):
                self.assertAlmostEqual(float(row["timestamp"]), i / 24, delta=6e-7)
                for column, curve in enumerate(CURVES):
                    key = "pose_" + curve if curve[0] == "R" else curve + "_r"
                    want = float(values[i, column]) / (2 if halve else 1)
                    self.assertAlmostEqual(float(row.pop(key)), want, delta=6e-7)
                self.assertEqual(row.pop("timestamp") is None, False)
                if first:
                    self.assertEqual([row.pop(k) for k in ("frame", "face_id", "confidence", "success")],
                                     [str(i + 1), "0", "1", "1"])
                self.assertEqual(set(map(float, row.values())), {0.0})  # what no network makes

    def test_csv(self):
        points, marks, values = self.figure([0, 1, 2], 9), self.figure([3, 4], 9), self.curves(9)
        values[0, 0] = 1e-30
        out = self.export("csv", "all.csv",
                          ["rate 24", *self.body([0, 1, 2]), "face \"a,b\" -1 0", "face c -1 4",
                           *(f"curve {c}" for c in CURVES)], points, marks, values)
        with open(out, newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(header, ["time", "body_Neck_x", "body_RShoulder_x", "body_RElbow_x",
                                  "body_Neck_y", "body_RShoulder_y", "body_RElbow_y", "face_\"a,b\"_x",
                                  "face_c_x", "face_\"a,b\"_y", "face_c_y", *CURVES])
        got = np.array(rows, np.float64)
        np.testing.assert_allclose(got[:, 0], np.arange(9) / 24, atol=6e-7)
        want = np.concatenate([points.reshape(9, -1), marks.reshape(9, -1), values], 1)
        self.assertTrue(np.array_equal(got[:, 1:].astype(np.float32), want))  # every bit

    def check_bvh(self, path, joints, want, rate, tolerance, coordinates):
        """`want` (frames, coordinates, joints) in cm, y up."""
        bvh = Bvh(path)
        self.assertEqual(bvh.frame_time, 1 / rate)
        readers = {"own": bvh.places()}
        if shutil.which("assimp"):
            readers["assimp"], ticks = assimp_places(path, self.folder)
            self.assertAlmostEqual(ticks, rate, delta=1e-4)
        for reader, places in readers.items():
            for column, joint in enumerate(joints):
                got = places[NAMES[joint]]
                self.assertEqual(len(got), len(want), reader)
                np.testing.assert_allclose(got[:, :coordinates], want[:, :coordinates, column],
                                           atol=tolerance, err_msg=f"{reader} {NAMES[joint]}")
        return bvh

    def test_bvh_in_the_plane(self):
        for joints, neck in ((range(11), 1), (range(52), 0), ([0, 1, 2], 1), ([1, 2, 3, 4], 0)):
            joints = list(joints)
            points = self.figure(joints, 40)
            want = points.astype(np.float64) * [[[1], [-1]]] * 18 / 167
            if 0 in joints:
                points[:, :, 0] = self.rng.normal(500, 30, (40, 2))
                middle = np.sort(points[:, :, 0].astype(np.float64), 0)[20]
                path = (points[:, :, 0] - middle) * [1, -1] * 18 / 167
                want += path[:, :, None] * neck
            out = self.export("bvh", "plane.bvh", ["rate 15", *self.body(joints), f"neck {neck}"], points)
            bvh = self.check_bvh(out, joints, want, 15, 2e-3, 2)
            self.assertLess(np.abs(np.diff(bvh.values[:, 3:], axis=0)).max(), 180)  # no full turns

    def test_bvh_of_points_that_are_no_tree(self):
        """Parents out of range, oneself and in a circle: bones from the root."""
        spec = ["rate 60", "body b\u00e4d 9 1", "body x 1 2", "body x 3 5", "body y 2 6"]
        angle = self.rng.normal(0, 0.2, (30, 4)).cumsum(0)
        points = (np.stack([np.cos(angle), np.sin(angle)], 1) * [100, 50, 70, 20]).astype(np.float32)
        points[:, :, 3] += points[:, :, 2]  # whose bone begins there, once the circle is cut
        bvh = Bvh(self.export("bvh", "odd.bvh", spec, points))
        self.assertEqual([j for j in bvh.joints if not j.startswith("To")],
                         ["Neck", "b__d", "x", "x_2", "y"])
        places = bvh.places()
        want = points.astype(np.float64) * [[[1], [-1]]] * 18 / 167
        for column, name in enumerate(("b__d", "x", "x_2", "y")):
            np.testing.assert_allclose(places[name][:, :2], want[:, :, column], atol=2e-3)

    def test_bvh_bones_have_their_median_length(self):
        points = self.figure(list(range(11)), 101)
        shrink = self.rng.uniform(0.3, 1.2, 101).astype(np.float32)
        points *= shrink[:, None, None]
        points[:, :, 0] = 0
        bvh = Bvh(self.export("bvh", "short.bvh", self.body(range(11)), points))
        lengths = {n: np.linalg.norm(o) for n, o in zip(bvh.joints, bvh.offsets)}
        for joint in range(1, 11):
            spans = points[:, :, joint] - points[:, :, PARENTS[joint]]
            want = np.median(np.linalg.norm(spans, axis=1)) * 18 / 167
            self.assertAlmostEqual(lengths[NAMES[joint]], want, delta=1e-4)
            # Directions are those of the points, whatever the length.
            place = bvh.places()
            got = (place[NAMES[joint]] - place[NAMES[PARENTS[joint]]])[:, :2] / want
            unit = spans / np.linalg.norm(spans, axis=1, keepdims=True) * [1, -1]
            np.testing.assert_allclose(got, unit, atol=1e-4)

    @staticmethod
    def arms():
        """(200, 3, 7): arms in space that swing before the body, y up."""
        frames = 200
        time = np.arange(frames)[:, None] / 15
        space = np.zeros((frames, 3, 7))
        for side, shoulder in ((-1, 1), (1, 4)):
            space[:, :, shoulder] = [side * 167, 0, 0]
            lift = 0.5 + 0.45 * np.sin(1.3 * time[:, 0] + side)  # upper arm, forwards from straight down
            out = 0.2 + 0.1 * np.cos(0.7 * time[:, 0])
            upper = np.stack([side * np.sin(out), -np.cos(out) * np.cos(lift), np.cos(out) * np.sin(lift)], 1)
            bend = lift + 0.9 + 0.5 * np.sin(2.1 * time[:, 0])  # the forearm, bent forwards
            fore = np.stack([side * np.sin(out), -np.cos(out) * np.cos(bend), np.cos(out) * np.sin(bend)], 1)
            space[:, :, shoulder + 1] = space[:, :, shoulder] + 220 * upper
            space[:, :, shoulder + 2] = space[:, :, shoulder + 1] + 200 * fore
        # Lengths are known when the arms are seen unshortened for a while.
        space[:20] = space[20]
        for side, shoulder in ((-1, 1), (1, 4)):
            space[:20, :, shoulder + 1] = space[:20, :, shoulder] + [side * 220, 0, 0]
            space[:20, :, shoulder + 2] = space[:20, :, shoulder + 1] + [side * 200, 0, 0]
        return space

    def test_bvh_lifted(self):
        """Arms seen from the front: the picture comes back exactly, the depth by its signs."""
        space, joints = self.arms(), list(range(7))
        points = space[:, :2] * [[[1], [-1]]]
        out = self.export("bvh3d", "space.bvh", ["rate 24", *self.body(joints)], points)
        want = space * 18 / 167
        bvh = self.check_bvh(out, joints, want, 24, 2e-3, 2)
        places = bvh.places()
        for joint in (2, 3, 5, 6):
            depth = np.abs(places[NAMES[joint]][:, 2] - want[:, 2, joint])
            self.assertLess(np.percentile(depth, 95), 0.6, NAMES[joint])  # cm
        self.assertGreater(np.abs(want[:, 2]).max(), 25)

    def test_arkit(self):
        values = self.curves(60)
        values[3, 0], values[4, 1] = 7, -1  # outside of 0 to 5
        out = self.export("arkit", "face.csv", ["rate 24", *(f"curve {c}" for c in CURVES)], values)
        with open(out, newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), LIVE_LINK)
        self.assertEqual([rows[i]["Timecode"] for i in (0, 23, 24, 59)],
                         ["00:00:00:00.000", "00:00:00:23.000", "00:00:01:00.000", "00:00:02:11.000"])
        for i, row in enumerate(rows):
            want = dict.fromkeys(LIVE_LINK[2:], 0.0)
            for column, unit in enumerate((1, 2, 4, 5, 6, 7)):
                for shape in SHAPES_OF[unit]:
                    want[shape] = min(1, max(0, float(values[i, column]) / 5))
            want["HeadPitch"], want["HeadYaw"], want["HeadRoll"] = values[i, 6], -values[i, 7], -values[i, 8]
            self.assertEqual(row["BlendshapeCount"], "61")
            for name, value in want.items():
                self.assertAlmostEqual(float(row[name]), value, delta=6e-7, msg=name)

    def test_vrm(self):
        values = self.curves(30)
        out = self.export("vrm", "face.json", ["rate 23.976", *(f"curve {c}" for c in CURVES)], values)
        file = json.loads(out.read_text(encoding="ascii"))
        self.assertEqual((file["frameRate"], file["frames"], file["specVersion"]), (23.976, 30, "1.0"))
        want = {s[0].lower() + s[1:]: column for column, unit in enumerate((1, 2, 4, 5, 6, 7))
                for s in SHAPES_OF[unit]}
        self.assertEqual(set(file["expressions"]), set(want))
        for i in range(30):
            for name, weight in zip(file["expressions"], file["weights"][i]):
                self.assertAlmostEqual(weight, float(values[i, want[name]]) / 5, delta=6e-7)
            x, y, z, w = file["head"][i]
            # OpenFace's rotation Rx Ry Rz in axes (right, down, away), seen in (right, up, near).
            camera = np.diag([1, -1, -1])
            rx, ry, rz = map(float, values[i, 6:])
            expected = camera @ turn("X", rx) @ turn("Y", ry) @ turn("Z", rz) @ camera
            np.testing.assert_allclose(matrix_of(w, x, y, z), expected, atol=1e-5)

    def test_vrma_of_a_face(self):
        values = self.curves(30)
        vrma = Vrma(self.export("vrma", "f.vrma", ["rate 24", *(f"curve {c}" for c in CURVES)], values))
        np.testing.assert_allclose(vrma.times, np.arange(30) / 24, atol=1e-6)
        for column, unit in enumerate((1, 2, 4, 5, 6, 7)):
            for shape in SHAPES_OF[unit]:
                track = vrma.tracks[shape[0].lower() + shape[1:], "translation"]
                np.testing.assert_allclose(track[:, 0], values[:, column] / 5, atol=1e-6)
                self.assertTrue((track[:, 1:] == 0).all())
        camera = np.diag([1, -1, -1])
        want = np.array([camera @ turn("X", rx) @ turn("Y", ry) @ turn("Z", rz) @ camera @ [0.1, 0.2, 1]
                         for rx, ry, rz in values[:, 6:].astype(np.float64)])
        np.testing.assert_allclose(vrma.turned("head", [0.1, 0.2, 1]), want, atol=1e-5)

    def test_vrma_of_a_body(self):
        """Its bones point where those of the lifted BVH do, which another reader has computed."""
        points, joints = self.arms()[:, :2] * [[[1], [-1]]], list(range(8))
        nose = self.rng.normal(0, 0.1, 200).cumsum()
        points = np.concatenate([points, np.stack([100 * np.sin(nose), -100 * np.cos(nose)], 1)[:, :, None]], 2)
        spec = ["rate 15", *self.body(joints)]
        places = Bvh(self.export("bvh3d", "b.bvh", spec, points)).places()
        path = self.export("vrma", "b.vrma", spec, points)
        vrma = Vrma(path)
        required = {"hips", "spine", "head", *(side + bone for side in ("left", "right") for bone in (
            "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot"))}
        self.assertEqual(set(vrma.nodes), required)
        for side, first, rest in (("left", "L", 1.0), ("right", "R", -1.0)):
            upper = places[first + "Elbow"] - places[first + "Shoulder"]
            fore = places[first + "Wrist"] - places[first + "Elbow"]
            got = vrma.turned(side + "UpperArm", [rest, 0, 0])
            np.testing.assert_allclose(got, upper / np.linalg.norm(upper, axis=1, keepdims=True), atol=1e-4)
            local = vrma.turned(side + "LowerArm", [rest, 0, 0])
            got = np.array([matrix_of(w, x, y, z) @ v for (x, y, z, w), v in
                            zip(vrma.tracks[side + "UpperArm", "rotation"], local)])
            np.testing.assert_allclose(got, fore / np.linalg.norm(fore, axis=1, keepdims=True), atol=1e-4)
        np.testing.assert_allclose(vrma.turned("head", [0, 1, 0])[:, :2],
                                   np.stack([np.sin(nose), np.cos(nose)], 1), atol=1e-5)
        if shutil.which("assimp"):
            for node, rotations in assimp_rotations(path, self.folder).items():
                np.testing.assert_allclose(rotations, vrma.tracks[node, "rotation"], atol=1e-5)

    def test_greta(self):
        values = self.curves(49)
        at = np.arange(int(49 * 25 / 24)) / 25 * 24
        slow = np.stack([np.interp(at, np.arange(49), v) for v in values.T.astype(np.float64)], 1)
        spec = ["rate 24", "name take_2", *(f"curve {c}" for c in CURVES)]
        name, fps, masks, got = read_greta(self.export("bap", "b.bap", spec, values), 295)
        self.assertEqual((name, fps, len(got)), ("take_2", 25, len(slow)))
        self.assertEqual(set(np.argwhere(masks)[:, 1]), {57, 58, 59})
        camera = np.diag([1, -1, -1])  # OpenFace's axes (right, down, away), seen in (left, up, forwards)
        for frame, (rx, ry, rz) in zip(got, slow[:, 6:]):
            want = camera @ turn("X", rx) @ turn("Y", ry) @ turn("Z", rz) @ camera
            np.testing.assert_allclose(greta_joint(frame, 59, 58, 57), want, atol=2e-5)
        name, fps, masks, got = read_greta(self.export("fap", "f.fap", spec, values), 69)
        self.assertEqual((name, fps, len(got)), ("take_2", 25, len(slow)))
        au = dict(zip((1, 2, 4, 5, 6, 7), slow.T / 5))
        want = {31: 200 * au[1] - 150 * au[4], 33: 100 * au[1] + 100 * au[2] - 100 * au[4],
                35: 200 * au[2] - 50 * au[4], 37: 100 * au[4], 41: 150 * au[6],
                19: 250 * au[7] - 350 * au[5], 21: 200 * au[6] + 300 * au[7]}
        self.assertEqual(set(np.argwhere(masks)[:, 1]), {f + side for f in want for side in (0, 1)})
        for fap, value in want.items():
            for side in (0, 1):
                np.testing.assert_allclose(got[:, fap + side], value, atol=0.51, err_msg=str(fap))

    def test_greta_arms(self):
        """Greta's joints, turned as she turns them, point where the lifted BVH's bones do."""
        joints, nose = list(range(8)), self.rng.normal(0, 0.1, 200).cumsum()
        points = np.concatenate([self.arms()[:, :2] * [[[1], [-1]]],
                                 np.stack([100 * np.sin(nose), -100 * np.cos(nose)], 1)[:, :, None]], 2)
        spec = ["rate 15", *self.body(joints)]
        places = Bvh(self.export("bvh3d", "b.bvh", spec, points)).places()
        _, _, masks, got = read_greta(self.export("bap", "b.bap", spec, points), 295)
        self.assertEqual(set(np.argwhere(masks)[:, 1]), {*range(32, 40), 57})
        self.assertEqual(len(got), 200 * 25 // 15)
        at = np.arange(len(got)) / 25 * 15
        down = np.array([0, -1, 0])
        for side, (first, flexion, twisting, abduct, elbow) in enumerate(
                (("L", 32, 36, 34, 38), ("R", 33, 37, 35, 39))):
            self.assertTrue((got[:, elbow] <= 0).all())  # elbows bend one way
            bones = []
            for begin, end in (("Shoulder", "Elbow"), ("Elbow", "Wrist")):
                bone = places[first + end] - places[first + begin]
                bone = np.stack([np.interp(at, np.arange(200), b) for b in bone.T], 1)
                bones.append(bone / np.linalg.norm(bone, axis=1, keepdims=True))
            for frame, upper, fore in zip(got, *bones):
                shoulder = greta_joint(frame, flexion, twisting, abduct)
                np.testing.assert_allclose(shoulder @ down, upper, atol=1e-4)
                hand = shoulder @ turn("X", frame[elbow] / 1e5) @ down
                self.assertLess(np.abs(hand - fore).max(), 0.021, side)  # a straight elbow has no side
        roll = np.interp(at, np.arange(200), nose)  # to the right of the picture, the figure's left
        self.assertLess(np.abs(np.exp(1j * got[:, 57] / 1e5) - np.exp(-1j * roll)).max(), 0.02)
        self.assertGreater(np.abs(got[:, 38]).max(), 1e5)

    def test_greta_knows_left_from_right(self):
        """Both arms out, then raised; then the forearms forwards, seen from the front as dots."""
        spec = ["rate 25", *self.body([1, 2, 3, 4, 5, 6])]
        out = [[-167, -367, -567, 167, 367, 567], [0] * 6]
        up = [[-167, -167, -167, 167, 167, 167], [0, -200, -400, 0, -200, -400]]
        hanging = [[-167, -167, -167, 167, 167, 167], [0, 200, 200, 0, 200, 200]]
        points = np.array([out] * 20 + [up] + [hanging], np.float32)
        _, _, _, got = read_greta(self.export("bap", "b.bap", spec, points), 295)
        quarter = np.pi / 2 * 1e5
        # left and right shoulder: flexion, abduct, twisting; then the elbows
        np.testing.assert_allclose(got[0, 32:40], [0, 0, quarter, -quarter, 0, 0, 0, 0], atol=1)
        np.testing.assert_allclose(np.abs(got[20, 34:36]), 2 * quarter, atol=1)
        np.testing.assert_allclose(got[21, 32:40], [0, 0, 0, 0, 0, 0, -quarter, -quarter], atol=1)


if __name__ == "__main__":
    if not shutil.which("assimp"):
        print("assimp-utils not installed: BVH is opened by the reader in this file alone")
    unittest.main()
