"""The figure as lines: which joints are joined, and what belongs to which side."""

import numpy as np

from ..networks import PATS_JOINTS

NAMES = [name for name, _, _ in PATS_JOINTS]
WRISTS = {"right": NAMES.index("RWrist"), "left": NAMES.index("LWrist")}
NECK, NOSE = NAMES.index("Neck"), NAMES.index("Nose")


def side_of(name):
    """"right" or "left" for what lies beyond a shoulder, "body" for the rest."""
    if name in ("Neck", "Nose") or name.endswith(("Eye", "Shoulder")):
        return "body"
    return "right" if name.startswith("R") else "left"


# (from, to, side) of each bone; the eyes are drawn as part of a head instead.
BONES = [(parent, i, side_of(name)) for i, (name, parent, _) in enumerate(PATS_JOINTS)
         if parent >= 0 and not name.endswith("Eye")]


def joints_of(pose):
    """(T, 22) -> (T, 11, 2), relative to the neck."""
    joints = pose.reshape(len(pose), 2, -1).transpose(0, 2, 1)
    return joints - joints[:, NECK : NECK + 1]


def head_of(joints):
    """Centre and radius of the head of one frame (11, 2)."""
    eyes = joints[[NAMES.index("REye"), NAMES.index("LEye")]].mean(axis=0)
    return (joints[NOSE] + eyes) / 2, 55.0


def extent(joints, margin=20):
    """(left, top, right, bottom) that holds the figure in all frames but the wildest."""
    head, radius = np.array([head_of(frame)[0] for frame in joints]), 55.0
    points = np.concatenate([joints, (head - radius)[:, None], (head + radius)[:, None]], axis=1)
    low = np.percentile(points.min(axis=1), 2, axis=0) - margin
    high = np.percentile(points.max(axis=1), 98, axis=0) + margin
    return (*low, *high)
