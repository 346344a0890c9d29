"""Fifteen of OpenPose's 70 points of the face, moved by the head, action units, blinks and the jaw.

In the order of docs/models.md: contour 0 4 8 12 16, right brow 17 19 21, left brow 22 24 26, right
lids 37 41, left lids 44 46.
"""

import numpy as np

from . import figure
from .profiles import bumps

# From the neck, of a face at rest: x, y, z as in figure.py.
_POINTS = np.array([
    (-66, -152, 5), (-52, -100, 25), (0, -68, 55), (52, -100, 25), (66, -152, 5),
    (-52, -180, 42), (-35, -188, 54), (-13, -181, 58), (13, -181, 58), (35, -188, 54),
    (52, -180, 42), (-28, -168, 52), (-28, -158, 52), (28, -168, 52), (28, -158, 52)], float)
_INNER, _MIDDLE, _OUTER = (7, 8), (6, 9), (5, 10)
_UPPER, _LOWER = (11, 13), (12, 14)
_JAW = ((2, 9.0), (1, 3.0), (3, 3.0))  # down at the loudest, in units


def face(times, units, angles, loudness, blinks, scale):
    """(frames, 30): x of the points, then y, from the neck, in units of pose/normalize; `scale`
    (frames,) of the pose."""
    au = dict(zip(("AU01", "AU02", "AU04", "AU05", "AU06", "AU07"), units.T))
    moved = np.zeros((len(times), len(_POINTS), 2))
    for point in _INNER:
        moved[:, point, 1] += -3.0 * au["AU01"] + 2.2 * au["AU04"]
        moved[:, point, 0] += np.sign(-_POINTS[point, 0]) * 0.9 * au["AU04"]
    for point in _MIDDLE:
        moved[:, point, 1] += -1.5 * au["AU01"] - 1.8 * au["AU02"] + 1.4 * au["AU04"]
    for point in _OUTER:
        moved[:, point, 1] += -2.6 * au["AU02"] + 0.6 * au["AU04"]
    closed = np.clip(bumps(times, [(t, 0.3, 1.0) for t in blinks]), 0, 1)
    for upper, lower in zip(_UPPER, _LOWER):
        moved[:, lower, 1] -= 0.8 * au["AU06"] + 0.9 * au["AU07"]
        moved[:, upper, 1] += -1.1 * au["AU05"] + 0.5 * au["AU07"]
        gap = _POINTS[lower, 1] + moved[:, lower, 1] - _POINTS[upper, 1] - moved[:, upper, 1]
        moved[:, upper, 1] += closed * (gap - 1.0) + (1 - closed) * np.minimum(gap - 1.0, 0)
    for point, down in _JAW:
        moved[:, point, 1] += down * loudness
    still = figure.head(_POINTS, angles)[..., :2]
    # The face's own movement is small, so it is turned with the head in the plane alone.
    moved = figure.leaned(moved, angles[:, 2])
    points = (still + moved) * scale[:, None, None]
    return points.transpose(0, 2, 1).reshape(len(times), -1)
