"""How a speaker of the corpus sounds and moves: the parameters that are known of them.

The first five are factors that the thesis' studies ask about (6.7.2); docs/training-data.md has the
formulas.  Styles are drawn independently of voices, so that one cannot be told from the other.
"""

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Style:
    amplitude: float  # factor on every stroke
    frequency: float  # 0 to 1: how little a word needs to get a stroke
    velocity: float  # factor on the speed of strokes
    arms: float  # -1 left alone, 0 both, 1 right alone
    turn: float  # rad, of the trunk to the speaker's left
    lean: float  # rad, of the trunk to the speaker's left shoulder
    rest_height: float  # 0 hands on the lap, 1 before the chest
    rest_spread: float  # 0 hands together, 1 apart
    head: float  # factor on the head's angles
    face: float  # factor on action units


# Lowest, highest, and whether between them the logarithm is spread evenly.
RANGES = {"amplitude": (0.55, 1.6, True), "frequency": (0.1, 1.0, False),
          "velocity": (0.7, 1.5, True), "arms": (-1.0, 1.0, False), "turn": (-0.45, 0.45, False),
          "lean": (-0.12, 0.12, False), "rest_height": (0.0, 1.0, False),
          "rest_spread": (0.0, 1.0, False), "head": (0.6, 1.5, True), "face": (0.6, 1.5, True)}
NEUTRAL = Style(1.0, 0.6, 1.0, 0.0, 0.0, 0.0, 0.3, 0.4, 1.0, 1.0)


def draw_styles(count, rng):
    """`count` styles that fill the ranges: each parameter has one value in each of `count` equal
    parts of its range (a Latin hypercube).  Every other two of three have a neutral face and head:
    Model 2, which takes no style, is trained on these."""
    columns = {}
    for name, (low, high, logarithmic) in RANGES.items():
        at = (rng.permutation(count) + rng.random(count)) / count
        if logarithmic:
            low, high = np.log(low), np.log(high)
        values = low + at * (high - low)
        columns[name] = np.exp(values) if logarithmic else values
    styles = []
    for n in range(count):
        values = {name: round(float(column[n]), 4) for name, column in columns.items()}
        if n % 3:
            values |= {"head": 1.0, "face": 1.0}
        styles.append(Style(**values))
    return styles


@dataclasses.dataclass(frozen=True)
class Voice:
    name: str  # as espeak-ng has it
    rate: int  # words a minute
    pitch: int  # 0 to 100
    range: int  # 0 to 100: how much the pitch moves
    gain: float  # dB
    noise: float  # dB of the room, re full scale
    pause: float  # factor on pauses


_LANGUAGES = ("en-us", "en", "en-gb-scotland", "en-gb-x-rp", "en-gb-x-gbclan",
              "en-gb-x-gbcwmd", "en-us-nyc", "en-029")
# Voices of the unseen are nobody else's.
_VARIANTS = {False: ("m1", "m2", "m3", "m4", "m6", "m7", "f1", "f2", "f3", "f4", "Alex", "Andy",
                     "steph", "linda"),
             True: ("m5", "m8", "f5", "Annie")}


def draw_voices(count, rng, unseen):
    variants = _VARIANTS[unseen]
    order = [variants[n] for _ in range(-(-count // len(variants)))
             for n in rng.permutation(len(variants))]
    return [Voice(f"{_LANGUAGES[rng.integers(len(_LANGUAGES))]}+{order[n]}",
                  int(rng.integers(135, 186)), int(rng.integers(30, 71)),
                  int(rng.integers(45, 91)), round(float(rng.uniform(-6, 0)), 2),
                  round(float(rng.uniform(-70, -52)), 2), round(float(rng.uniform(0.7, 1.5)), 3))
            for n in range(count)]


def fields(what):
    return dataclasses.asdict(what)
