"""infer-cli eval against NumPy and SciPy: every figure, to 1e-5 of its value.

eval_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import csv
import html.parser
import io
import json
import os
import re
import sys
import unittest

import numpy as np
from scipy.ndimage import median_filter

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "cli"))
import eval_reference as reference  # noqa: E402
from cli_harness import CliTest, golden  # noqa: E402

UNITS = ("AU01", "AU02", "AU04", "AU05", "AU06", "AU07")
CHANNELS = UNITS + ("Rx", "Ry", "Rz")
TOLERANCE = 1e-5


class EvalTest(CliTest):

    def setUp(self):
        super().setUp()
        self.random = np.random.default_rng(20231)

    def eval(self, *arguments):
        return json.loads(self.good("eval", "--json", *arguments))

    def put(self, name, **arrays):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        return self.save(name, arrays)

    def assert_figure(self, got, want, where):
        if want is None:
            self.assertIsNone(got, where)
            return
        self.assertIsNotNone(got, where)
        self.assertLessEqual(abs(got - want), TOLERANCE * abs(want) + 1e-12, (where, got, want))

    def assert_scores(self, got, want, where):
        for name, value in want.items():
            self.assert_figure(got[name], value, (where, name))

    def poses(self, frames, joints=11, spread=80.0):
        start = self.random.normal(0, spread, 2 * joints)
        return (start + np.cumsum(self.random.normal(0, 4, (frames, 2 * joints)), 0)).astype("f4")

    def curves(self, items=5, steps=40, scale=0.7):
        values = np.round(np.clip(self.random.normal(0.5, scale, (items, steps, 9)), 0, 5), 2)
        return {"face": values.astype("f4"),
                "lengths": self.random.integers(0, steps + 1, (items, 9)).astype("i4")}


def joined(p, t, n):
    """Channel n of two files, item by item, each cut to the shorter."""
    pieces = []
    for i in range(len(p["face"])):
        length = min(p["lengths"][i, n], t["lengths"][i, n])
        pieces.append((p["face"][i, :length, n], t["face"][i, :length, n]))
    return [np.concatenate(side) if pieces else np.zeros(0) for side in zip(*pieces)]


class CurvesTest(EvalTest):

    def check(self, scores, columns, median=7):
        self.assertEqual([c["name"] for c in scores["channels"]], list(CHANNELS))
        wants = []
        for score, (p, t) in zip(scores["channels"], columns):
            unit = score["name"] in UNITS
            wants.append(reference.channel(p, t, median, unit))
            self.assertEqual(score["values"], len(p))
            self.assert_scores(score, wants[-1], score["name"])
            self.assertEqual("ahr_count" in score, unit)
        for group, members in ((scores["means"][0], wants[:6]), (scores["means"][1], wants[6:])):
            for measure in members[0]:
                defined = [w[measure] for w in members if w[measure] is not None]
                self.assert_figure(group[measure], np.mean(defined) if defined else None,
                                   (group["group"], measure))

    def test_one_by_one_and_all_together(self):
        pairs = {}
        for name, items in (("a", 1), ("b", 7), ("c.d", 4)):
            pairs[name] = self.curves(items), self.curves(items)
            self.put(f"p/{name}.out.npz", **pairs[name][0])
            self.put(f"t/{name}.npz", **pairs[name][1])
        for median in (1, 3, 7, 31):
            report = self.eval("p", "t", "--median", str(median))
            self.assertEqual([s["name"] for s in report["sequences"]], list(pairs))
            columns = {k: [joined(*v, n) for n in range(9)] for k, v in pairs.items()}
            for scores in report["sequences"]:
                self.check(scores, columns[scores["name"]], median)
            together = [[np.concatenate([columns[k][n][side] for k in pairs]) for side in (0, 1)]
                        for n in range(9)]
            self.check(report["all"], together, median)
        self.assertIn("lengths differ", "".join(report["notes"]))

    def test_what_is_undefined(self):
        p, t = self.curves(2), self.curves(2)
        t["face"][..., 0] = 0.25           # AU01: constant, never active
        t["face"][..., 1] = 3              # AU02: always active
        p["lengths"][:, 2] = 0             # AU04: nothing
        p["lengths"][:, 6] = (1, 0)        # Rx: a single value
        t["lengths"][:] = 40
        p["lengths"][:, (0, 1)] = 40
        self.put("x/p.npz", **p)
        self.put("x/t.npz", **t)
        report = self.eval("x/p.npz", "x/t.npz", "--median", "1")
        self.check(report["all"], [joined(p, t, n) for n in range(9)], 1)
        by_name = {c["name"]: c for c in report["all"]["channels"]}
        for name, undefined in (("AU01", ["ahr_count", "ahr_intensity", "pcc"]),
                                ("AU02", ["nahr", "pcc"]), ("Rx", ["pcc"])):
            self.assertEqual(sorted(k for k, v in by_name[name].items() if v is None), undefined)
        self.assertTrue(all(v is None for k, v in by_name["AU04"].items()
                            if k in ("rmse", "pcc", "nahr", "accuracy_count")))
        text = self.good("eval", "x/p.npz", "x/t.npz", "--median", "1")
        self.assertIn("undefined", text)
        self.assertNotIn("nan", text.lower())

    def test_no_sequences_at_all(self):
        nothing = {"face": np.zeros((0, 9, 9), "f4"), "lengths": np.zeros((0, 9), "i4")}
        self.put("x/p.npz", **nothing)
        report = self.eval("x/p.npz", "x/p.npz")
        self.assertTrue(all(c["rmse"] is None for c in report["all"]["channels"]))

    def test_against_a_recording_by_time(self):
        p = self.curves(4, 30)
        begins = np.array([0, 1000, 1500, 4000])  # the second is cut short by the third
        p["times_ms"] = np.stack([begins, begins + 900], 1).astype("i4")
        self.put("x/p.npz", **p)
        truth = self.csv("x/t.csv", 110)
        report = self.eval("x/p.npz", "x/t.csv")
        starts = [round(b * 24 / 1000) for b in begins] + [10 ** 6]
        columns = []
        for n in range(9):
            pairs = [(p["face"][i, s, n], truth[starts[i] + s, n]) for i in range(4)
                     for s in range(p["lengths"][i, n])
                     if starts[i] + s < min(len(truth), starts[i + 1])]
            columns.append(np.array(pairs).reshape(-1, 2).T)
        self.check(report["all"], columns)
        del p["times_ms"]
        self.put("x/q.npz", **p)
        self.bad("eval", "x/q.npz", "x/t.csv", says=("q.npz", "times_ms"))

    def csv(self, name, frames, rate=24.0, order=range(9)):
        values = np.round(np.clip(self.random.normal(0.5, 0.7, (frames, 9)), 0, 5), 2)
        with open(self.path(name), "w", encoding="ascii", newline="") as file:
            out = csv.writer(file)
            out.writerow(["frame", "timestamp", "confidence", "success"] +
                         [("pose_" + CHANNELS[n]) if n > 5 else CHANNELS[n] + "_r" for n in order])
            for i, row in enumerate(values):
                out.writerow([i + 1, f"{i / rate:.6f}", 0.98, 1, *row[list(order)]])
        return values.astype("f4")

    def test_hit_ratios_are_shown_wherever_the_action_units_stand(self):
        self.csv("p.csv", 20, order=(6, 0, 7, 1, 8, 2, 3, 4, 5))
        report = self.eval("p.csv", "p.csv")
        self.assertEqual([m["group"] for m in report["all"]["means"]], ["head", "action units"])
        self.assertEqual([m["channels"] for m in report["all"]["means"]], [3, 6])
        self.assertRegex(self.good("eval", "p.csv", "p.csv"),
                         r"AHR sum %[^\n]*\n(.*\n)*  AU01 +0 +1\.000 +100\.0 +100\.0 +100\.0")

    def test_recordings_of_unequal_length(self):
        p, t = self.csv("p.csv", 61), self.csv("t.csv", 50)
        report = self.eval("p.csv", "t.csv")
        self.check(report["all"], [(p[:50, n], t[:, n]) for n in range(9)])
        self.assertIn("lengths differ", "".join(report["notes"]))

    def test_recordings_of_unequal_rate_are_resampled(self):
        p, t = self.csv("p.csv", 60), self.csv("t.csv", 75, 30.0)
        report = self.eval("p.csv", "t.csv")
        at = np.arange(60) * 30 / 24
        self.check(report["all"], [(p[:, n], np.interp(at, np.arange(75), t[:, n]).astype("f4"))
                                   for n in range(9)])
        self.assertIn("resampled from 30", "".join(report["notes"]))


class PosesTest(EvalTest):

    SOURCES = list(range(11))
    MOVING = slice(1, 11)

    def points(self, arrays, frames):
        """Joints without the neck, then face points: (frames, points, 2)."""
        parts = [reference.joints(arrays["pose"])[:frames, self.MOVING]]
        if "face" in arrays:
            parts.append(reference.joints(arrays["face"])[:frames])
        return np.concatenate(parts, 1)

    def check(self, scores, cases, sets, order=2.0):
        """`cases`: {role: arrays} each; `sets`: the arrays of every role."""
        rate = 15.0
        behaviour = {role: reference.behaviour([a["pose"] for a in arrays], rate, self.SOURCES)
                     for role, arrays in sets.items()}
        for name in reference.BEHAVIOURS:
            got = scores["behaviour"][name]
            for role, values in behaviour.items():
                self.assert_figure(got[role], values[name], (name, role))
            if "target" not in behaviour or "source" not in behaviour:
                continue
            s, p, t = (behaviour[r][name] for r in ("source", "prediction", "target"))
            self.assert_figure(got["dist_avg_source"], reference.dist_avg(s, s, p, t), name)
            self.assert_figure(got["dist_avg_prediction"], reference.dist_avg(p, s, p, t), name)
            if got["dist_avg_source"] is not None:
                self.assertAlmostEqual(got["dist_avg_source"] + got["dist_avg_prediction"], 100)
        for role in ("truth", "source", "target"):
            pairs = [self.pair(case, role) for case in cases if role in case]
            self.assertEqual(role in scores["minkowski"], bool(pairs))
            if pairs:
                self.assert_scores(scores["minkowski"][role], reference.minkowski(pairs, order),
                                   role)
            if role == "source" and pairs:
                a, b = (np.concatenate([np.ravel(pair[side]) for pair in pairs]) for side in (0, 1))
                self.assert_figure(scores["content_preservation"], reference.cosine(a, b), "7.5")
            if role == "truth" and pairs:
                self.check_columns(scores, pairs)

    def pair(self, case, role):
        frames = min(len(case["prediction"]["pose"]), len(case[role]["pose"]))
        both = [self.points(case[r], frames) for r in ("prediction", role)]
        fewest = min(side.shape[1] for side in both)
        return [side[:, :fewest] for side in both]

    def check_columns(self, scores, pairs):
        p, t = (np.concatenate([pair[side] for pair in pairs]) for side in (0, 1))
        self.assertEqual(len(scores["channels"]), 2 * p.shape[1])
        for i, score in enumerate(scores["channels"]):
            want = reference.channel(p[:, i // 2, i % 2], t[:, i // 2, i % 2], 1)
            self.assert_scores(score, want, score["name"])

    def test_everything_of_folders(self):
        sets = {role: [] for role in ("prediction", "truth", "source", "target")}
        for i, (frames, other) in enumerate(((64, 64), (17, 20), (33, 5))):
            for role, length in zip(sets, (frames, other, frames + 2, 40 + i)):
                arrays = {"pose": self.poses(length), "face": self.poses(length, 15)}
                self.put(f"{role}/{i}.npz", **arrays)
                sets[role].append(arrays)
        cases = [dict(zip(sets, case)) for case in zip(*sets.values())]
        for order in ("2", "1", "3.5", "100"):
            report = self.eval("prediction", "truth", "--source", "source", "--target", "target",
                               "--order", order)
            self.check(report["all"], cases, sets, float(order))
            contents = []
            for scores, case in zip(report["sequences"], cases):
                self.check(scores, [case], {k: [v] for k, v in case.items()}, float(order))
                contents.append(scores["content_preservation"])
            self.assert_figure(report["content_preservation_mean"], np.mean(contents), "mean")
        self.assertIn("the first 5 were compared", "".join(report["notes"]))

    def test_one_target_serves_all_and_others_only_pool(self):
        sets = {role: [] for role in ("prediction", "source", "target")}
        for i in range(2):
            for role in ("prediction", "source"):
                arrays = {"pose": self.poses(20)}
                self.put(f"{role}/{i}{role[0] if role == 'source' else ''}.npz", **arrays)
                sets[role].append(arrays)
        sets["target"] = [{"pose": self.poses(31)}]
        self.put("target.npz", style_pose=sets["target"][0]["pose"])
        report = self.eval("prediction", "--source", "source", "--target", "target.npz")
        cases = [{"prediction": p, "target": sets["target"][0]} for p in sets["prediction"]]
        self.check(report["all"], cases, sets)
        self.assertNotIn("content_preservation", report["all"])
        self.assertIn("0 of 2 predictions have a source", "".join(report["notes"]))

    def test_short_motion(self):
        for frames in (0, 1, 2, 3, 4):
            case = {role: {"pose": self.poses(frames)} for role in
                    ("prediction", "truth", "source", "target")}
            for role, arrays in case.items():
                self.put(f"x/{role}.npz", **arrays)
            report = self.eval("x/prediction.npz", "x/truth.npz", "--source", "x/source.npz",
                               "--target", "x/target.npz")
            self.check(report["all"], [case], {k: [v] for k, v in case.items()})
            defined = sum(b["prediction"] is not None
                          for b in report["all"]["behaviour"].values())
            self.assertEqual(defined, (0, 1, 3, 5, 7)[frames])

    def test_still_and_zero_motion(self):
        case = {role: {"pose": np.zeros((9, 22), "f4")} for role in
                ("prediction", "truth", "source", "target")}
        self.put("x/0.npz", **case["truth"])
        report = self.eval("x/0.npz", "x/0.npz", "--source", "x/0.npz", "--target", "x/0.npz")
        self.check(report["all"], [case], {k: [v] for k, v in case.items()})
        self.assertIsNone(report["all"]["content_preservation"])
        self.assertIsNone(report["all"]["behaviour"]["jerk"]["dist_avg_source"])
        self.assertEqual(report["all"]["means"][0]["rmse"], 0)
        self.assertIsNone(report["all"]["means"][0]["pcc"])

    def test_huge_values_stay_finite(self):
        huge = np.where(self.random.random((30, 22)) < 0.5, -3e38, 3e38).astype("f4")
        self.put("x/p.npz", pose=huge)
        self.put("x/t.npz", pose=-huge)
        for ending in ("json", "csv", "html", "txt"):
            text = self.good("eval", "x/p.npz", "x/t.npz", "--source", "x/t.npz", "--order", "100",
                             "-o", "r." + ending)
            with open(self.path("r." + ending), encoding="utf-8") as file:
                text += file.read()
            self.assertEqual(re.findall(r"(?i).{20}[^a-z](?:nan|inf)[^a-z]", text), [])

    def test_frame_rate(self):
        pose = self.poses(30)
        self.put("x/p.npz", pose=pose)
        slow, fast = (self.eval("x/p.npz", "--fps", fps)["all"]["behaviour"]["jerk"]["prediction"]
                      for fps in ("10", "20"))
        self.assert_figure(fast, 8 * slow, "jerk")

    def test_finished_predictions_and_plain_truths(self):
        """Arrays of unlike rates: the truth is brought to the prediction's, not taken for it."""
        pose = self.poses(30)
        fast = np.stack([np.interp(np.arange(60) / 2, np.arange(30), c) for c in pose.T], 1)
        self.put("x/p.npz", pose=fast.astype(np.float32), frame_rate=np.float32(30))
        self.put("x/t.npz", pose=pose)
        report = self.eval("x/p.npz", "x/t.npz")
        self.assertIn("x/t.npz: resampled from 15.00 to 30.00 frames per second", report["notes"])
        self.assertEqual((report["frame_rate"], report["all"]["frames"]), (30, 60))
        for score in report["all"]["channels"]:
            self.assertLess(score["rmse"], 1e-3)
        values = self.random.uniform(0, 1, (20, 9)).astype(np.float32)
        self.put("x/f.npz", face=values, frame_rate=np.float32(48))
        self.put("x/g.npz", face=values[::2], frame_rate=np.float32(24))
        report = self.eval("x/f.npz", "x/g.npz")
        slow = np.repeat(values[::2], 2, 0).astype(np.float64)
        slow[1:-1:2] = (slow[0:-2:2] + slow[2::2]) / 2
        for column, score in enumerate(report["all"]["channels"]):
            self.assert_figure(score["rmse"], reference.channel(values[:, column].astype(np.float64),
                                                                slow[:, column])["rmse"], score["name"])
        self.put("x/w.npz", face=values.reshape(2, 10, 9), lengths=np.full((2, 9), 10, np.int32))
        self.bad("eval", "x/f.npz", "x/w.npz", says=["curves at 24.00 frames per second, expected 48.00"])

    def test_openpose_with_joints_that_were_never_seen(self):
        frames = 23
        truth = self.openpose("filmed", frames, missing=(15,))  # PATS 8, the right eye
        pose = self.poses(frames)
        self.put("x/p.npz", pose=pose)
        report = self.eval("x/p.npz", "filmed")
        self.assertIn("REye", "".join(report["notes"]))
        p = reference.joints(pose)
        for score in report["all"]["channels"]:
            joint, axis = score["name"].split()
            if joint == "LHandRoot":  # taken from the wrist, which PATS lists as well
                continue
            at = ["Neck", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist", "Nose",
                  "REye", "LEye"].index(joint)
            x = "xy".index(axis)
            want = reference.channel(p[:, at, x], truth[:, at, x], 1)
            self.assert_figure(score["rmse"], want["rmse"], score["name"])
        self.assertFalse([s for s in report["all"]["channels"] if s["name"].startswith("REye")])

    def test_folders_of_recordings(self):
        for name in ("a", "b"):
            self.openpose("filmed/" + name, 9)
            self.put(f"made/{name}.npz", pose=self.poses(9))
        report = self.eval("made", "filmed")
        self.assertEqual([s["name"] for s in report["sequences"]], ["a", "b"])
        same = self.eval("filmed", "filmed")["all"]
        self.assertEqual({m["rmse"] for m in same["means"]}, {0})
        self.assertEqual(same["minkowski"]["truth"], {"per_point": 0, "per_frame": 0})

    def openpose(self, folder, frames, missing=()):
        """BODY_25 frames; returns PATS' first ten joints as they should be read."""
        order = [1, 2, 3, 4, 5, 6, 7, 0, 15, 16]
        shape = np.array([(300, 200), (250, 205), (240, 260), (260, 300), (350, 205), (360, 260),
                          (340, 300), (300, 150), (292, 140), (308, 140)], float)
        at = np.round(shape + self.random.normal(0, 3, (frames, 10, 2)), 3)
        os.makedirs(self.path(folder))
        for i, frame in enumerate(at):
            keypoints = np.zeros((25, 3))
            keypoints[order] = np.column_stack([frame, np.full(10, 0.9)])
            keypoints[list(missing)] = 0
            with open(self.path(f"{folder}/v_{i:012d}_keypoints.json"), "w",
                      encoding="ascii") as file:
                json.dump({"version": 1.3, "people": [{"person_id": [-1],
                           "pose_keypoints_2d": keypoints.ravel().tolist()}]}, file)
        smooth = median_filter(at, size=(7, 1, 1), mode="nearest")
        scale = 167 / np.linalg.norm(smooth[:, 1] - smooth[:, 0], axis=1)
        return (smooth - smooth[:, :1]) * scale[:, None, None]


class TransferTest(EvalTest):

    def test_agrees_with_pytorch(self):
        for case in ("classifier_three_layers", "classifier_one_layer"):
            with np.load(golden(case + ".npz")) as arrays:
                motion, strength = arrays["motion"], arrays["strength"]
            self.put("x/p.npz", pose=motion)
            report = self.eval("x/p.npz", "--weights", golden(case + ".fb"))
            transfer = report["all"]["transfer"]["prediction"]
            self.assertEqual(transfer["pieces"], len(strength))
            self.assertEqual(transfer["taken_for_target"], int((strength > 0.5).sum()))
            self.assert_figure(transfer["percent"], 100 * np.mean(strength > 0.5), case)
            self.assertFalse(report["trained"])

    def test_of_many_and_of_source_and_target(self):
        weights = golden("classifier_three_layers.fb")
        self.save("all.npz", {"motion": self.poses(40, 3, 1.0)})
        counts = {}
        for role in ("p", "s", "t"):
            counts[role] = [0, 0]
            for i, frames in enumerate((5, 12)):
                pose = self.poses(frames, 3, 40.0)
                self.put(f"{role}/{i}.npz", pose=pose)
                self.save("motion.npz", {"motion": pose})
                self.good(weights, "motion.npz", "-o", "out.npz")
                with np.load(self.path("out.npz")) as out:
                    counts[role][0] += int((out["strength"] > 0.5).sum())
                    counts[role][1] += len(out["strength"])
        report = self.eval("p", "--source", "s", "--target", "t", "--weights", weights,
                           "--classifier", "classifier")
        for role, name in (("p", "prediction"), ("s", "source"), ("t", "target")):
            got = report["all"]["transfer"][name]
            self.assertEqual([got["taken_for_target"], got["pieces"]], counts[role])

    def test_face_beside_the_pose(self):
        with np.load(golden("classifier_three_layers.npz")) as arrays:
            motion, strength = arrays["motion"], arrays["strength"]
        self.put("x/p.npz", pose=motion[:, :4], face=motion[:, 4:])
        report = self.eval("x/p.npz", "--weights", golden("classifier_three_layers.fb"))
        self.assertEqual(report["all"]["transfer"]["prediction"]["taken_for_target"],
                         int((strength > 0.5).sum()))

    def test_motion_without_all_points_is_not_judged(self):
        weights = golden("classifier_three_layers.fb")
        self.put("x/p.npz", pose=self.poses(5, 3))
        self.put("x/s.npz", pose=self.poses(5, 2))
        report = self.eval("x/p.npz", "--source", "x/s.npz", "--weights", weights)
        self.assertEqual(report["all"]["transfer"]["source"],
                         {"taken_for_target": 0, "pieces": 0, "percent": None})
        self.assertIn("s.npz: has not all points", "".join(report["notes"]))

    def test_weights_name_joints(self):
        with np.load(golden("zs_mstm2_parallel.npz")) as arrays:
            self.put("x/p.npz", pose=arrays["pose"], face=arrays["face"])
        report = self.eval("x/p.npz", "--weights", golden("zs_mstm2_parallel.fb"))
        self.assertEqual(report["notes"], [])
        self.assertIn("were taken for", "".join(self.eval("x/p.npz")["notes"]))


class Tags(html.parser.HTMLParser):
    VOID = {"meta", "path", "rect", "br"}

    def __init__(self):
        super().__init__()
        self.open, self.svgs = [], 0

    def handle_starttag(self, tag, attrs):
        self.svgs += tag == "svg"
        for name, value in attrs:
            if name in ("src", "href") or "http" in (value or ""):
                raise AssertionError((tag, name, value))
        if tag in ("svg", "figure", "table", "details", "p", "ul", "figcaption"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open and self.open[-1] == tag:
            self.open.pop()


class ReportsTest(EvalTest):

    def setUp(self):
        super().setUp()
        for role in ("p", "t", "s", "g"):
            for name in ("a,b", '<i>"q"&'):
                self.put(f"{role}/{name}.npz", pose=self.poses(30))
        self.arguments = ("eval", "p", "t", "--source", "s", "--target", "g")

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def test_csv_holds_what_json_holds(self):
        self.good(*self.arguments, "-o", "r.csv")
        self.good(*self.arguments, "-o", "r.json")
        report = json.loads(self.read("r.json"))
        rows = list(csv.DictReader(io.StringIO(self.read("r.csv"))))
        self.assertEqual({r["sequence"] for r in rows}, {"all", "a,b", '<i>"q"&'})
        for scores in [dict(report["all"], name="all"), *report["sequences"]]:
            own = {(r["group"], r["subject"], r["measure"]): r["value"] for r in rows
                   if r["sequence"] == scores["name"]}
            for name, by_role in scores["behaviour"].items():
                for role in ("prediction", "truth", "source", "target"):
                    self.assertEqual(float(own["behaviour", role, name]), by_role[role])
                self.assertEqual(float(own["dist_avg", "source", name]), by_role["dist_avg_source"])
            for channel in scores["channels"]:
                self.assertEqual(float(own["body", channel["name"], "pcc"]), channel["pcc"])
            self.assertEqual(float(own["content", "prediction", "content_preservation"]),
                             scores["content_preservation"])

    def test_undefined_is_an_empty_cell(self):
        self.put("x/p.npz", pose=np.zeros((1, 22), "f4"))
        self.good("eval", "x/p.npz", "-o", "r.csv")
        self.assertIn("all,behaviour,prediction,velocity,,units/s\n", self.read("r.csv"))

    def test_page_stands_alone(self):
        self.good(*self.arguments, "-o", "r.html")
        page = self.read("r.html")
        tags = Tags()
        tags.feed(page)
        self.assertEqual(tags.open, [])
        self.assertEqual(tags.svgs, 3)  # distances, behaviour, wrists
        self.assertNotRegex(page, r"(?i)https?:|@import|url\(")
        self.assertNotIn('<i>"q"&', page)
        self.assertIn("&lt;i&gt;&quot;q&quot;&amp;", page)
        for words in ("prefers-color-scheme", "6.9", "Dist. (prediction, target)"):
            self.assertIn(words, page)
        report = self.eval(*self.arguments[1:])
        shown = re.findall(r"Dist\. \(source, target\): ([\d.]+)", page)
        want = [report["all"]["behaviour"][b]["dist_avg_source"] for b in reference.BEHAVIOURS]
        np.testing.assert_allclose([float(s) for s in shown], want, rtol=1e-3)

    def test_page_of_curves_and_of_nothing(self):
        self.put("x/p.npz", **self.curves(3))
        self.put("x/t.npz", **self.curves(3))
        nothing = {"face": np.zeros((2, 9, 9), "f4"), "lengths": np.zeros((2, 9), "i4")}
        self.put("x/0.npz", **nothing)
        self.put("x/00.npz", pose=np.zeros((0, 22), "f4"))
        for p, t, svgs in (("p", "t", 3 + 9), ("0", "0", 3), ("00", "00", 1)):
            self.good("eval", f"x/{p}.npz", f"x/{t}.npz", "-o", "r.html")
            tags = Tags()
            tags.feed(self.read("r.html"))
            self.assertEqual((tags.open, tags.svgs), ([], svgs))
            self.assertEqual(re.findall(r"(?i).{20}[^a-z](?:nan|inf)[^a-z]", self.read("r.html")),
                             [])

    def test_text_says_the_same_on_the_terminal_and_in_a_file(self):
        text = self.good(*self.arguments, "-o", "r.txt")
        self.assertEqual(text, self.read("r.txt"))
        for words in ("content preservation", "jerk", "one by one", "wrote r.txt"):
            self.assertIn(words, text)

    def test_same_bytes_every_time(self):
        for ending in ("csv", "html", "json", "txt"):
            self.good(*self.arguments, "-o", "r." + ending)
            first = self.read("r." + ending)
            self.good(*self.arguments, "-o", "r." + ending)
            self.assertEqual(first, self.read("r." + ending))


class BadInputTest(EvalTest):

    def test_arrays(self):
        good = self.curves(2)
        self.put("x/t.npz", **good)
        pose = np.zeros((3, 22), "f4")
        for arrays, says in (
                ({"speech": pose}, ("holds no motion", "pose")),
                ({"pose": pose.ravel()}, ("pose: (66,)", "points")),
                ({"pose": np.zeros((3, 5), "f4")}, ("pose: (3, 5)",)),
                ({"pose": np.zeros((3, 106), "f4")}, ("pose: (3, 106)", "52")),
                ({"pose": pose, "face": np.zeros((4, 30), "f4")}, ("face: (4, 30)", "3")),
                ({"pose": pose + np.nan}, ("pose",)),
                ({"face": good["face"]}, ("lengths: missing",)),
                ({"face": good["face"], "lengths": good["lengths"][:1]}, ("lengths: (1, 9)",)),
                ({"face": good["face"], "lengths": good["lengths"] + 41}, ("lengths: ", "40")),
                ({"face": good["face"], "lengths": -1 - good["lengths"]}, ("lengths: -",)),
                ({**good, "times_ms": np.zeros((3, 2), "i4")}, ("times_ms: (3, 2)",)),
                ({**good, "times_ms": np.full((2, 2), 2 ** 31 - 1, "i4")}, ("times_ms: 2147483647",)),
                ({**good, "times_ms": np.full((2, 2), -1, "i4")}, ("times_ms: -1",)),
                ({"face": good["face"][:1], "lengths": good["lengths"][:1]}, ("times_ms",)),
                ({"pose": pose}, ("nothing to compare",))):
            self.put("x/p.npz", **arrays)
            if says == ("nothing to compare",):
                self.put("x/p.npz", face=good["face"][..., :4], lengths=good["lengths"][:, :4])
            self.bad("eval", "x/p.npz", "x/t.npz", says=("x/", *says))

    def test_files(self):
        self.put("x/p.npz", pose=self.poses(5))
        self.write("words.json", b'{"words": []}')
        self.write("zip.npz", b"PK\x03\x04")
        self.write("bad.csv", b"frame,AU01_r\n1,many\n")
        os.makedirs(self.path("empty"))
        os.makedirs(self.path("y"))
        self.write("y/note.bin", b"\x00\x01")
        self.put("twice/a.npz", pose=self.poses(5))
        self.put("twice/a.out.npz", pose=self.poses(5))
        for path, says in (("none.npz", ()), ("words.json", ("holds no motion",)), ("zip.npz", ()),
                           ("bad.csv", ("many",)), ("empty", ("holds no motion",)),
                           ("y", ("holds no motion",)), ("twice", ("the same name",))):
            self.bad("eval", "x/p.npz", path, says=(path.split("/")[0], *says))
            self.bad("eval", path, "x/p.npz", says=says)
        self.put("other/q.npz", pose=self.poses(5))
        self.bad("eval", "x", "other", says=("no truth has the name", "p.npz"))

    def test_alone_ones_are_noted(self):
        for name in ("p/a", "p/b", "t/b", "t/c"):
            self.put(name + ".npz", pose=self.poses(5))
        self.write("t/readme.txt", b"hello")
        report = self.eval("p", "t")
        self.assertEqual([s["name"] for s in report["sequences"]], ["b"])
        for words in ("p/a.npz was left out", "t/c.npz was left out", "t/readme.txt was not used"):
            self.assertIn(words, "".join(report["notes"]))

    def test_options(self):
        self.put("x/p.npz", pose=self.poses(5))
        weights = golden("classifier_three_layers.fb")
        for options, says in ((("--median", "4"), "odd"), (("--median", "0"), "median"),
                              (("--order", "0.5"), "order"), (("--fps", "0"), "fps"),
                              (("-o", "r.pdf"), ".html"), (("-o", "no/r.csv"), "no/r.csv"),
                              (("--classifier", "c"), "--weights"),
                              (("--weights", weights, "--classifier", "c"), "no classifier c"),
                              (("--weights", weights, "--network", "c"), "no network c"),
                              (("--weights", weights, "--classifier", "classifier"), "6 columns"),
                              (("--weights", "x/p.npz"), "x/p.npz"), (("a", "b"), "")):
            self.bad("eval", "x/p.npz", *options, says=(says,))
        self.bad("eval", says=("PREDICTIONS",))
        report = self.eval("x/p.npz", "--weights", weights)
        self.assertIn("no transfer strength", "".join(report["notes"]))


if __name__ == "__main__":
    unittest.main()
