"""The figure: a trunk, two arms of two links and a head in space, seen from in front.

Axes as in a picture: x to the right (the speaker's left), y down, z towards the viewer.  Units are
those of PATS' pose/normalize: 167 from the neck to a shoulder.  The neck is the origin.
"""

import numpy as np

UNIT = 167.0
UPPER_ARM, FOREARM, HAND = 235.0, 205.0, 40.0
SHOULDER = np.array([166.0, 18.0, 0.0])  # the speaker's left one; the right one is its mirror image
# The elbow hangs where the arm leaves it free: outward, down and a little back.
_POLE = np.array([0.45, 1.0, -0.35])
# Of the head, from the neck.
PIVOT = np.array([0.0, -62.0, 0.0])
NOSE = np.array([0.0, -135.0, 75.0])
EYES = np.array([[-26.0, -163.0, 52.0], [26.0, -163.0, 52.0]])


def rest(style):
    """(outward, up, forward) of a wrist from its shoulder, at rest."""
    high = style.rest_height
    return np.array([-95.0 + 85.0 * style.rest_spread, -330.0 + 120.0 * high, 95.0 + 75.0 * high])


def turned(points, angle):
    """Points (frames, ..., 3) about the vertical axis; positive to the speaker's left."""
    return _rotated(points, angle, 0, 2)


def leaned(points, angle):
    """In the plane of the picture; positive: the speaker's left side goes down."""
    return _rotated(points, angle, 0, 1)


def nodded(points, angle):
    """About the axis through the ears; positive: the face looks down."""
    return _rotated(points, angle, 2, 1)


def _rotated(points, angle, a, b):
    points = np.array(points, float)
    angle = np.reshape(angle, (-1,) + (1,) * (points.ndim - 2))
    x, y = points[..., a].copy(), points[..., b].copy()
    sign = -1 if (a, b) == (0, 2) else 1
    points[..., a] = np.cos(angle) * x - sign * np.sin(angle) * y
    points[..., b] = sign * np.sin(angle) * x + np.cos(angle) * y
    return points


def arm(shoulder, way, side):
    """(elbow, wrist, hand), each (frames, 3).  way: (frames, 3) outward, up and forward from the
    shoulder; side: 1 for the speaker's left, -1.  A wrist out of reach stays on the line to where
    it was wanted."""
    to = way * [side, -1, 1]
    length = np.linalg.norm(to, axis=1, keepdims=True)
    reach = np.clip(length, 1.1 * (UPPER_ARM - FOREARM), 0.995 * (UPPER_ARM + FOREARM))
    axis = to / np.maximum(length, 1e-9)
    along = (UPPER_ARM**2 - FOREARM**2 + reach**2) / (2 * reach)
    pole = _POLE * [side, 1, 1]
    off = pole - (axis @ pole)[:, None] * axis
    off /= np.linalg.norm(off, axis=1, keepdims=True)
    elbow = shoulder + along * axis + np.sqrt(UPPER_ARM**2 - along**2) * off
    wrist = shoulder + reach * axis
    return elbow, wrist, wrist + HAND / FOREARM * (wrist - elbow)


def head(points, angles):
    """Points of the head (n, 3) -> (frames, n, 3); angles (frames, 3): OpenFace's Rx (positive:
    down), Ry (positive: to the speaker's left) and Rz (positive: the speaker's left ear goes
    down)."""
    turned_to = np.tile(points - PIVOT, (len(angles), 1, 1))
    turned_to = nodded(turned_to, angles[:, 0])
    turned_to = turned(turned_to, angles[:, 1])
    return leaned(turned_to, angles[:, 2]) + PIVOT


def pose(left, right, shrug, turn, lean, angles):
    """(frames, 22): x of PATS' first eleven joints, then y, scaled so that 167 lie between neck and
    right shoulder in every frame, as PATS does it.

    left, right: (frames, 3) ways of the wrists from their shoulders; shrug (frames,) up; turn, lean
    (frames,) of the trunk; angles (frames, 3) of the head."""
    lift = np.stack([np.zeros_like(shrug), -shrug, np.zeros_like(shrug)], axis=1)
    shoulders = {side: SHOULDER * [side, 1, 1] + lift for side in (-1, 1)}
    arms = {-1: arm(shoulders[-1], right, -1), 1: arm(shoulders[1], left, 1)}
    trunk = np.stack([shoulders[-1], *arms[-1][:2], shoulders[1], *arms[1][:2], arms[1][2]], axis=1)
    trunk = leaned(turned(trunk, turn), lean)
    face = head(np.concatenate([NOSE[None], EYES]), angles)
    neck = np.zeros((len(turn), 1, 3))
    joints = np.concatenate([neck, trunk[:, :6], face, trunk[:, 6:]], axis=1)[..., :2]
    scale = UNIT / np.linalg.norm(joints[:, 1], axis=1)
    return (joints * scale[:, None, None]).transpose(0, 2, 1).reshape(len(turn), -1), scale
