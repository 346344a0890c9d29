"""The measures of infer-cli eval in NumPy and SciPy, as the thesis' formulas read."""

import warnings

import numpy as np
from scipy import signal, stats
from scipy.spatial import distance

BEHAVIOURS = ("velocity", "acceleration", "jerk", "wrist_velocity", "wrist_acceleration",
              "wrist_jerk", "box_perimeter")
NECK, WRISTS = 0, (3, 6)


def rmse(p, t):
    return np.sqrt(np.mean((p - t) ** 2)) if len(p) else None


def pcc(p, t):
    if len(p) < 2 or np.ptp(p) == 0 or np.ptp(t) == 0:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return stats.pearsonr(p, t)[0]


def ratio(part, whole):
    return 100 * part / whole if whole else None


def channel(p, t, median=7, unit=False):
    """Thesis 5.5.6 of one column of values; both are filtered, as the released code does."""
    p, t = (np.asarray(x, float) for x in (p, t))
    if median > 1 and len(p):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            p, t = signal.medfilt(p, median), signal.medfilt(t, median)
    scores = {"rmse": rmse(p, t), "pcc": pcc(p, t)}
    if unit:
        kept_p, kept_t = np.where(p > 0.5, p, 0), np.where(t > 0.5, t, 0)
        scores |= {"ahr_intensity": ratio(kept_p.sum(), kept_t.sum()),
                   "ahr_count": ratio((p > 0.5).sum(), (t > 0.5).sum()),
                   "nahr": ratio((p <= 0.5).sum(), (t <= 0.5).sum()),
                   "accuracy_intensity": ratio((kept_p == kept_t).sum(), len(p)),
                   "accuracy_count": ratio(((p > 0.5) == (t > 0.5)).sum(), len(p))}
    return scores


def joints(pose):
    """(frames, joints, 2) of columns x of all, then y of all."""
    pose = np.asarray(pose, float)
    return pose.reshape(len(pose), 2, pose.shape[1] // 2).transpose(0, 2, 1)


def mean(values):
    return float(np.mean(values)) if np.size(values) else None


def behaviour(poses, rate, sources):
    """Thesis 6.7.1 of several sequences; `sources`: PATS' number of each column's joint."""
    moving = [i for i, s in enumerate(sources) if s != NECK]
    wrists = [i for i, s in enumerate(sources) if s in WRISTS]
    result = {}
    for order, name in ((1, "velocity"), (2, "acceleration"), (3, "jerk")):
        for prefix, chosen in (("", moving), ("wrist_", wrists)):
            norms = [np.linalg.norm(np.diff(joints(pose)[:, chosen], order, axis=0), axis=2).ravel()
                     for pose in poses if len(pose) > order]
            norms = np.concatenate(norms) if norms else np.zeros(0)
            result[prefix + name] = mean(norms * rate ** order)
    perimeters = []
    for pose in poses:
        at = joints(pose)
        if NECK in sources:
            at[:, sources.index(NECK)] = 0
        perimeters += [2 * np.ptp(frame, axis=0).sum() for frame in at]
    result["box_perimeter"] = mean(perimeters)
    return result


def dist_avg(x, source, prediction, target):
    """Equation 6.9."""
    if None in (source, prediction, target):
        return None
    whole = abs(source - target) + abs(prediction - target)
    return 100 * abs(x - target) / whole if whole else None


def cosine(a, b):
    """Equation 7.5, in percent."""
    a, b = np.asarray(a, float).ravel(), np.asarray(b, float).ravel()
    norms = np.linalg.norm(a) * np.linalg.norm(b)
    return 100 * (1 - distance.cosine(a, b)) if norms else None


def minkowski(pairs, order):
    """Of (frames, points, 2) pairs: the mean over points, and over frames as a whole."""
    points, frames = [], []
    for a, b in pairs:
        for x, y in zip(a, b):
            frames.append(distance.minkowski(x.ravel(), y.ravel(), order))
            points += [distance.minkowski(i, j, order) for i, j in zip(x, y)]
    return {"per_point": mean(points), "per_frame": mean(frames)}
