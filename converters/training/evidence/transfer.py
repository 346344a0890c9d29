"""ZS-MSTM: is the motion better than what needs no network, is the style the target's, and does the
timing come from the speech?"""

import numpy as np

from ...kinds import zs_mstm2
from . import material

_WRISTS = (3, 6)
_RATE = 15.0
MEASURES = ("wrist_velocity", "wrist_acceleration", "wrist_jerk", "box_perimeter")
RIVALS = ("model", "mean pose", "copied source", "shuffled audio")


def evidence(found, network, condition, sources_of_each, most=None):
    """The figures of one condition, "seen" or "unseen" styles, `most` of them, as a dictionary."""
    pairs = list(_pairs(found.data, condition, sources_of_each, most))
    folder = found.work / f"{network}-{condition}"
    rows, faces = [], []
    for n, (utterance, other, speaker) in enumerate(pairs):
        made = {"model": found.motion(utterance, speaker, network),
                "truth": found.truth(utterance, speaker, network),
                "copied source": found.recorded(utterance, network),
                "shuffled audio": found.motion(other, speaker, network)}
        style, held_out = (_joined([found.recorded(u, network) for u in utterances])
                           for utterances in found.clips(speaker))
        made["mean pose"] = {stream: _still(x, utterance.frames) for stream, x in style.items()}
        made["target"] = held_out
        for name, motion in made.items():
            material.save(folder / name, f"{n:03d}", **motion)
        poses = {name: motion["pose"] for name, motion in made.items()}
        if "face" in made["model"]:
            faces.append(_expressing({name: _expressions(made[name]["face"])
                                      for name in ("model", "shuffled audio", "truth")}))
        rows.append({"speaker": speaker, **_timing(poses),
                     **{f"{name} {key}": value for name in ("model", "target", "truth")
                        for key, value in _habits(poses[name]).items()}})
    report = _against(found, folder, "model", "target")
    return {"pairs": len(pairs), "rivals": _rivals(found, folder), "nearness": _nearness(report),
            "dist": _dist(report, _against(found, folder, "model", "truth"),
                          _against(found, folder, "truth", "target")),
            "timing": {name: float(np.mean([row[name] for row in rows]))
                       for name in ("same speech", "other speech")},
            "style": _following(rows),
            "expressions": {part: np.mean([face[part] for face in faces], 0).tolist()
                            for part in (faces[0] if faces else ())}}


def _joined(motions):
    return {stream: np.concatenate([motion[stream] for motion in motions]) for stream in motions[0]}


def _still(x, length):
    """The mean of (frames, columns), `length` times."""
    return np.tile(x.mean(0, dtype=np.float64).astype(np.float32), (length, 1))


def _pairs(data, condition, sources_of_each, most):
    """(an utterance of the test split, another one of another text, target speaker)"""
    tests = data.select("test")
    targets = data.speakers("train" if condition == "seen" else "unseen")
    count = min(most or len(targets), len(targets))
    targets = [targets[n * len(targets) // count] for n in range(count)]
    for n, speaker in enumerate(targets):
        for k in range(sources_of_each):
            others = [u for u in tests if u.speaker != speaker]
            yield (others[(7 * n + 13 * k) % len(others)],
                   others[(7 * n + 13 * k + 5) % len(others)], speaker)


def _rivals(found, folder):
    """{rival: mean error and correlation of the joints against the truth of the transfer, and of the
    landmarks where the network makes a face}"""
    figures = {}
    for name in RIVALS:
        all_of_it = found.evaluate(folder / name, folder / "truth")["all"]
        groups = {group["group"]: group for group in all_of_it["means"]}
        figures[name] = {"rmse": groups["body"]["rmse"], "pcc": groups["body"]["pcc"],
                         "per_point": all_of_it["minkowski"]["truth"]["per_point"]}
        if "face" in groups:
            figures[name] |= {"face_rmse": groups["face"]["rmse"],
                              "face_pcc": groups["face"]["pcc"]}
    return figures


def _against(found, folder, name, target):
    """What `infer-cli eval` says of motion whose truth, source and target are known."""
    return found.evaluate(folder / name, folder / "truth", "--source", folder / "copied source",
                          "--target", folder / target)


def _nearness(report):
    """Table 7.6, and equation 7.5 of Table 7.5: is the motion nearer to the target speaker's than to
    the source's, joints and landmarks alike, and how much of the source's is kept?"""
    distances = report["all"]["minkowski"]
    return {**{role: distances[role]["per_point"] for role in ("source", "target", "truth")},
            "content": report["all"]["content_preservation"]}


def _dist(report, exact, gesturer):
    """Eq. 6.9 of each measure: distances of all pairs added up, then put in proportion; the mean of
    the pairs' own percentages; and what the gesturer has, who knows the style: no two utterances of
    a speaker move alike."""
    return {measure: {"pooled": _pooled(report, measure), "mean": _mean(report, measure),
                      "exact": _pooled(exact, measure), "gesturer": _pooled(gesturer, measure)}
            for measure in MEASURES}


def _pooled(report, measure):
    source, model = (sum(sequence["behaviour"][measure][f"dist_{name}"]
                         for sequence in report["sequences"]) for name in ("source", "prediction"))
    return 100 * model / (source + model)


def _mean(report, measure):
    return float(np.mean([sequence["behaviour"][measure]["dist_avg_prediction"]
                          for sequence in report["sequences"]]))


def _speeds(pose):
    """(T - 1,) mean speed of the wrists, units a second, over three frames."""
    points = pose.reshape(len(pose), 2, -1)[:, :, _WRISTS]
    speed = _RATE * np.linalg.norm(np.diff(points, axis=0), axis=1).mean(1)
    return np.convolve(speed, np.ones(3) / 3, mode="same")


def _timing(poses):
    """Correlation of the wrists' speed with the truth's: of the same speech, and of another's, as long
    as both speak."""
    return {"same speech": _together(poses["model"], poses["truth"]),
            "other speech": _together(poses["shuffled audio"], poses["truth"])}


def _together(pose, truth):
    length = min(len(pose), len(truth))
    return _correlation(_speeds(pose[:length]), _speeds(truth[:length]))


def _correlation(x, y):
    length = min(len(x), len(y))
    return np.corrcoef(x[:length], y[:length])[0, 1]


def _expressions(face):
    """What a face does beside turning, (T,) units each, as distances in the picture: the jaw's and the
    brows' from the eyes, between the lids; and the eyes' own from the neck, which are nods."""
    points, y = [n for n, _ in zs_mstm2.FACE_POINTS], face.reshape(len(face), 2, -1)[:, 1]

    def height(*numbers):
        return y[:, [points.index(n) for n in numbers]].mean(1)

    upper, lower = height(37, 44), height(41, 46)
    eyes = (upper + lower) / 2
    return {"jaw": height(8) - eyes, "brows": upper - height(17, 19, 21, 22, 24, 26),
            "lids": lower - upper, "nods": eyes}


def _expressing(parts):
    """{part: (correlation with the truth of the same speech, with other speech, deviation as a share
    of the truth's)}"""
    return {name: (_correlation(parts["model"][name], truth),
                   _correlation(parts["shuffled audio"][name], truth),
                   parts["model"][name].std() / truth.std())
            for name, truth in parts["truth"].items()}


def _habits(pose):
    """What a style shows in: how fast the wrists are, how high, and which of them moves more."""
    points = pose.reshape(len(pose), 2, -1)
    moves = [np.linalg.norm(np.diff(points[:, :, w], axis=0), axis=1).mean() for w in _WRISTS]
    return {"speed": _RATE * float(np.mean(moves)),
            "height": -float(points[:, 1, _WRISTS].mean()),
            "spread": float(np.std(points[:, :, _WRISTS], axis=0).mean()),
            "right hand": float(moves[0] / (sum(moves) + 1e-6)),
            "shoulders": float(np.abs(points[:, 0, 1] - points[:, 0, 4]).mean())}


def _following(rows):
    """Correlation over target speakers of their own habits with those of what is made in their
    style, by the model and by the gesturer, which knows the style."""
    speakers = sorted({row["speaker"] for row in rows})
    habits = [key.removeprefix("target ") for key in rows[0] if key.startswith("target ")]

    def means(name, habit):
        return [np.mean([row[f"{name} {habit}"] for row in rows if row["speaker"] == speaker])
                for speaker in speakers]

    return {habit: {name: float(np.corrcoef(means(name, habit), means("target", habit))[0, 1])
                    for name in ("model", "truth")} for habit in habits}
