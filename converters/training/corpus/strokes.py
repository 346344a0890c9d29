"""Which words get a stroke, of which shape and size, and where that takes the wrists."""

import dataclasses

import numpy as np

from . import lexicon

# Of each shape the way from the rest to where it is prepared and to where the stroke ends, in units
# of pose/normalize: (outward, up, forward); and how much the other hand takes part.
SHAPES = {
    "beat": ((10, 160, 75), (30, 70, 110), 0.25),
    "wide": ((-25, 190, 75), (190, 205, 50), 1.0),
    "narrow": ((10, 190, 90), (-55, 150, 110), 1.0),
    "raise": ((10, 75, 60), (55, 275, 50), 0.6),
    "lower": ((25, 225, 50), (55, 20, 75), 0.6),
    "away": ((-75, 160, 75), (155, 110, 75), 0.8),
    "count": ((-10, 240, 75), (5, 160, 125), 0.15),
    "open": ((25, 90, 75), (125, 160, 100), 0.9),
    "chest": ((-40, 150, 50), (-95, 230, 25), 0.3),
    "temple": ((25, 190, 25), (40, 305, 10), 0.15),
    "sweep": ((-95, 150, 75), (170, 140, 60), 0.35),
    "point": ((-10, 150, 100), (75, 190, 160), 0.1),
    "offer": ((-10, 90, 75), (25, 145, 190), 0.5),
}
# Seconds at velocity 1.
_PREPARE, _STROKE, _RETRACT, _HOLD = 0.30, 0.34, 0.75, 0.30
_OVERLAP = 0.75  # of the preparation is over when the stroke begins


@dataclasses.dataclass(frozen=True)
class Stroke:
    time: float  # s, when the preparation begins: at the word's onset or up to a frame later
    end: float  # s, of the word
    shape: str
    size: float  # factor: amplitude of the style, prominence, chance
    right: bool  # the hand that leads
    prominence: float


def prominence(word, accent, emphasis=False):
    """How much a word calls for a stroke, 0 to 1: what it is, and how it is said."""
    _, weight, shape = lexicon.look_up(word)
    return min(1.0, weight * (0.7 + 0.3 * accent) + 0.1 * emphasis * (weight > 0)), shape


def threshold(style):
    """The least prominence that gets a stroke."""
    return 0.78 - 0.48 * style.frequency


def plan(words, accents, style, rng):
    """[Stroke] of [(text, start, end, emphasis)].  Draws the same random numbers in every style, so
    that two styles of one utterance differ by the styles alone."""
    strokes, free = [], -np.inf
    pause = 1.0 - 0.65 * style.frequency  # s between onsets
    for (text, start, end, emphasis), accent in zip(words, accents):
        drop, late, noise = rng.random(), rng.random(), rng.normal()
        strength, shape = prominence(text, accent, emphasis)
        if strength < threshold(style) or start < free or drop < 0.04:
            continue
        size = style.amplitude * (0.7 + 0.4 * strength) * (1 + np.clip(0.07 * noise, -0.15, 0.15))
        right = lexicon.fraction("hand " + text.lower().strip(".,?!")) < (1 + style.arms) / 2
        strokes.append(Stroke(start + 0.04 * late, end, shape, size, right, strength))
        free = start + pause
    return strokes


def share(style, right, stroke):
    """How much a hand takes part in a stroke, 0 to 1."""
    most = min(1.0, 1 + style.arms if right else 1 - style.arms)
    return most * (1.0 if right == stroke.right else SHAPES[stroke.shape][2])


def wrist_targets(strokes, style, right):
    """[(time, duration, (outward, up, forward) from the rest)] for profiles.moves"""
    targets = []
    prepare, beat = _PREPARE / style.velocity, _STROKE / style.velocity
    # Hands that rest high have less way to go up.
    way = np.array([1, 1 - 0.45 * style.rest_height, 1 - 0.4 * style.rest_height])
    for n, stroke in enumerate(strokes):
        size = stroke.size * share(style, right, stroke)
        if size < 0.05:
            continue
        ready, done, _ = SHAPES[stroke.shape]
        begin = stroke.time + _OVERLAP * prepare
        targets.append((stroke.time, prepare, size * way * ready))
        targets.append((begin, beat, size * way * done))
        back = max(begin + beat, stroke.end) + _HOLD
        if n + 1 == len(strokes) or strokes[n + 1].time > back:
            targets.append((back, _RETRACT / style.velocity, np.zeros(3)))
    return targets
