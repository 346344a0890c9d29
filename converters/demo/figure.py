"""The figure as lines: which joints are joined, and what belongs to which side."""

import numpy as np

from ..kinds.zs_mstm1 import PATS_JOINTS

NAMES = [name for name, _, _ in PATS_JOINTS]
WRISTS = {"right": NAMES.index("RWrist"), "left": NAMES.index("LWrist")}
NECK, NOSE = NAMES.index("Neck"), NAMES.index("Nose")


def part_of(name):
    """"right" or "left" for what lies beyond a shoulder, "hand" for what lies beyond a wrist,
    "body" for the rest."""
    if name in ("Neck", "Nose") or name.endswith(("Eye", "Shoulder")):
        return "body"
    if name.endswith("HandRoot"):
        return "hand"
    return "right" if name.startswith("R") else "left"


# (from, to, part) of each bone; nose and eyes are drawn as a head instead.
BONES = [(parent, i, part_of(name)) for i, (name, parent, _) in enumerate(PATS_JOINTS)
         if parent >= 0 and name != "Nose" and not name.endswith("Eye")]
_HEAD = 55.0  # radius


def joints_of(pose):
    """(T, 22) -> (T, 11, 2), relative to the neck."""
    joints = pose.reshape(len(pose), 2, -1).transpose(0, 2, 1)
    return joints - joints[:, NECK : NECK + 1]


def head_of(joints):
    """Centre and radius of the head of one frame (11, 2)."""
    eyes = joints[[NAMES.index("REye"), NAMES.index("LEye")]].mean(axis=0)
    return (joints[NOSE] + eyes) / 2, _HEAD


def neck_of(joints):
    """The line from the neck to the edge of the head."""
    centre, radius = head_of(joints)
    length = max(np.linalg.norm(centre - joints[NECK]), radius)
    return joints[NECK], centre + (joints[NECK] - centre) * radius / length


def extent(joints, margin=20):
    """(left, top, right, bottom) that holds the figure in all frames but the wildest."""
    head = np.array([head_of(frame)[0] for frame in joints])
    points = np.concatenate([joints, (head - _HEAD)[:, None], (head + _HEAD)[:, None]], axis=1)
    low = np.percentile(points.min(axis=1), 2, axis=0) - margin
    high = np.percentile(points.max(axis=1), 98, axis=0) + margin
    return (*low, *high)
