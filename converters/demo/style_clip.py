"""A stand-in for the recorded pose of a target speaker: a figure at rest that beats with its arms.

PATS, whose poses the thesis uses, may not be passed on, and no freely licensed clip has both speech
and PATS' joints.
"""

import numpy as np

from ..kinds.zs_mstm1 import PATS_JOINTS
from .recordings import loudness

_NAMES = [name for name, _, _ in PATS_JOINTS]


def synthetic_pose(recording, frames, rate):
    """(frames, 22): x of every joint, then y, in units of PATS' pose/normalize.  The forearms swing
    with the loudness of the speech."""
    at = np.arange(frames) / rate
    level = loudness(recording.samples, recording.rate)
    level = np.convolve(level / level.max(), np.ones(25) / 25, mode="same")
    lift = np.interp(at, np.arange(len(level)) * 0.01, level)
    pose = np.tile(np.array([xy for _, _, xy in PATS_JOINTS], np.float64), (frames, 1, 1))
    for side, wrist, others in ((-1, "RWrist", ()), (1, "LWrist", ("LHandRoot",))):
        beat = np.sin(2 * np.pi * (0.9 + 0.1 * side) * at)
        move = np.stack([side * (30 + 40 * beat) * lift, -220 * lift + 25 * beat], axis=1)
        for name in (wrist, *others):
            pose[:, _NAMES.index(name)] += move
        pose[:, _NAMES.index(wrist[0] + "Elbow")] += 0.3 * move
    nod = 6 * np.sin(2 * np.pi * 0.5 * at)
    for name in ("Nose", "REye", "LEye"):
        pose[:, _NAMES.index(name), 1] += nod
    return pose.transpose(0, 2, 1).reshape(frames, -1).astype(np.float32)
