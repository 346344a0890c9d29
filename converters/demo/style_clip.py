"""A stand-in for a video of a target speaker: a figure at rest that beats with its arms, written as
OpenPose writes what it sees.

PATS, whose poses the thesis uses, may not be passed on, and no freely licensed clip has both speech
and PATS' joints.
"""

import json

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


# Where BODY_25 has PATS' first joints; hands are files' own lists.
_BODY_25 = {"Neck": 1, "RShoulder": 2, "RElbow": 3, "RWrist": 4, "LShoulder": 5, "LElbow": 6,
            "LWrist": 7, "Nose": 0, "REye": 15, "LEye": 16}
_NECK, _SCALE = (640.0, 280.0), 0.6  # in a picture of 1280 x 720


def write_openpose(pose, folder):
    """Writes the frames of `pose`, as of `synthetic_pose`, to `folder`, a file each."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*_keypoints.json"):
        old.unlink()
    points = pose.reshape(len(pose), 2, -1).transpose(0, 2, 1) * _SCALE + _NECK
    for number, frame in enumerate(points):
        body = np.zeros((25, 3))
        for name, place in _BODY_25.items():
            body[place] = (*frame[_NAMES.index(name)], 0.9)
        hand = np.zeros((21, 3))
        hand[0] = (*frame[_NAMES.index("LHandRoot")], 0.9)
        person = {"pose_keypoints_2d": np.round(body, 2).ravel().tolist(),
                  "hand_left_keypoints_2d": np.round(hand, 2).ravel().tolist()}
        path = folder / f"clip_{number:012d}_keypoints.json"
        path.write_text(json.dumps({"version": 1.3, "people": [person]}))
