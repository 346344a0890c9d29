"""Motion of an utterance in a style: what was said and how, to poses, faces and action units."""

import numpy as np

from . import face, figure, landmarks, strokes
from .profiles import moves

FRAME_RATE, FACE_RATE = 15.0, 24.0  # of poses; of the face, as the thesis' videos
_IDLE = 1.2  # units: how far a resting hand drifts


def gesture(words, sentences, prosody, seconds, style, seed):
    """{"pose": (T, 22), "face": (T, 30), "au": (F, 9), "strokes": [strokes.Stroke]}

    words: [(text, start, end, emphasis)]; sentences: [(act, start, end)]; prosody: prosody.Prosody;
    style: style.Style.  The same seed draws the same chance in every style, so that another style
    gives the truth of a transfer."""
    times = np.arange(int(seconds * FRAME_RATE + 1e-6)) / FRAME_RATE
    video = np.arange(int(seconds * FACE_RATE + 1e-6)) / FACE_RATE
    streams = [np.random.default_rng([seed, n]) for n in range(4)]
    planned = strokes.plan(words, prosody.accent, style, streams[0])
    prominences = [strokes.prominence(text, accent, emphasis)[0]
                   for (text, _, _, emphasis), accent in zip(words, prosody.accent)]
    units, angles = face.curves(video, words, prominences, sentences, prosody, style, streams[1])
    at = [np.interp(times, video, column) for column in np.hstack([units, angles]).T]
    seen = np.stack(at, axis=1)
    pose, scale = _pose(times, planned, style, seen[:, 6:], streams[2])
    marks = landmarks.face(times, seen[:, :6], _head(style, seen[:, 6:]),
                           prosody.at("loudness", times), face.blinks(words, streams[3]), scale)
    return {"pose": pose.astype(np.float32), "face": marks.astype(np.float32),
            "au": np.hstack([units, angles]).astype(np.float32), "strokes": planned}


def _head(style, angles):
    """The head looks into the camera more than the trunk does."""
    return angles + np.array([0.0, 0.35 * style.turn, 0.3 * style.lean])


def _pose(times, planned, style, angles, rng):
    ways = {}
    for right in (True, False):
        targets = strokes.wrist_targets(planned, style, right)
        ways[right] = figure.rest(style) + moves(times, np.zeros(3), targets)
        ways[right] += _IDLE * _slow(times, rng, 3)
    shrug = _pulse(times, planned, style, ("open",), 14.0)
    side = _pulse(times, planned, style, ("wide", "sweep", "point"), 0.06, signed=True)
    turn = style.turn + side + 0.008 * _slow(times, rng, 1)[:, 0]
    lean = style.lean + 0.2 * side + 0.004 * _slow(times, rng, 1)[:, 0]
    return figure.pose(ways[False], ways[True], shrug, turn, lean, _head(style, angles))


def _pulse(times, planned, style, shapes, height, signed=False):
    """The trunk goes along with strokes of some shapes, towards the hand that leads."""
    targets = []
    for stroke in planned:
        if stroke.shape in shapes:
            side = -1 if signed and stroke.right else 1
            targets += [(stroke.time, 0.6 / style.velocity, [height * stroke.size * side]),
                        (stroke.time + 0.8 / style.velocity, 0.8 / style.velocity, [0.0])]
    targets.sort(key=lambda target: target[0])
    return moves(times, np.zeros(1), targets)[:, 0]


def _slow(times, rng, columns):
    """(frames, columns) of deviation 1, slower than 0.5 Hz."""
    frequencies, phases = rng.uniform(0.08, 0.45, (2, columns, 3))
    waves = np.sin(2 * np.pi * (frequencies[None] * times[:, None, None] + 10 * phases[None]))
    return waves.sum(axis=2) / np.sqrt(1.5)
