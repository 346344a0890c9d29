"""Action units and the head's angles: pulses on words, states of sentences, the contour of f0.

Nearly all of it follows from what Model 2 takes, words and f0 of an inter-pausal unit.
"""

import numpy as np

from . import lexicon
from .profiles import bumps, plateaus

AU_NAMES = ("AU01", "AU02", "AU04", "AU05", "AU06", "AU07")
ANGLES = ("Rx", "Ry", "Rz")

# Height of an action unit's pulse on a word of a class, at prominence 1.
_WORD_PULSES = {
    "DEGREE": {"AU05": 2.6, "AU01": 0.8, "AU02": 0.8},
    "BIG": {"AU05": 3.0, "AU01": 1.0, "AU02": 1.0},
    "SMALL": {"AU07": 2.2, "AU04": 0.6},
    "NEGATION": {"AU04": 2.6, "AU07": 1.2}, "NO": {"AU04": 2.6, "AU07": 1.2},
    "BAD": {"AU04": 2.2, "AU07": 1.6}, "FALL": {"AU04": 1.2}, "FALLS": {"AU04": 1.2},
    "GOOD": {"AU06": 2.6, "AU07": 0.8}, "FEEL": {"AU06": 1.8}, "FEELING": {"AU06": 1.4},
    "THANKS": {"AU06": 2.8, "AU01": 0.8}, "GREET": {"AU06": 2.4, "AU01": 1.2, "AU02": 1.2},
    "YES": {"AU06": 1.6}, "SORRY": {"AU01": 2.4, "AU04": 2.2},
    "WH": {"AU04": 1.4, "AU02": 0.8}, "THINK": {"AU04": 1.2, "AU07": 0.8},
    "MAYBE": {"AU02": 1.6, "AU01": 1.0}, "RISE": {"AU05": 1.6}, "RISES": {"AU05": 1.6},
    "MANY": {"AU05": 1.8, "AU02": 1.0},
}
# Brows on every accented word, however it is classed.
_ACCENT = {"AU01": 2.0, "AU02": 2.2}
# While a sentence of an act lasts.
_QUESTION = {"AU01": 1.3, "AU02": 1.3, "Rx": -0.10, "Rz": 0.12}
_SENTENCES = {
    "Yes-No-Question": _QUESTION, "Declarative Yes-No-Question": _QUESTION,
    "Tag-Question": _QUESTION, "Or-Clause": _QUESTION, "Open-Question": _QUESTION,
    "Wh-Question": {"AU04": 1.1, "AU01": 0.3, "Rz": 0.14},
    "Rhetorical-Questions": {"AU04": 0.8, "AU02": 0.6, "Rz": -0.14},
    "Apology": {"AU01": 1.2, "AU04": 1.2, "Rx": 0.16},
    "Thanking": {"AU06": 1.2, "Rx": 0.10}, "Appreciation": {"AU06": 1.0, "AU05": 0.8, "Rx": -0.08},
    "Agree/Accept": {"AU06": 0.7}, "Conventional-opening": {"AU06": 1.2, "AU01": 0.5, "AU02": 0.5},
    "Conventional-closing": {"AU06": 1.0}, "Hedge": {"AU07": 0.8, "Rz": -0.12},
    "Maybe/Accept-part": {"AU02": 0.6, "Rz": -0.12}, "Negative non-no answers": {"AU04": 0.6},
    "Statement-opinion": {"AU07": 0.4}, "Action-directive": {"AU05": 0.5, "Rx": 0.06},
}
_BASE = 0.15  # of an action unit that does nothing
_HIGHEST = 4.5
# Where the head turns on a word, in rad: shapes of strokes that point somewhere.
_TURNS = {"point": 0.24, "sweep": 0.30, "offer": 0.12, "wide": 0.16}
_SHAKES, _NODS = ("NEGATION", "NO"), ("YES",)


def curves(times, words, prominences, sentences, prosody, style, rng):
    """(action units (frames, 6) 0 to 5, angles (frames, 3) rad) at `times`.

    words: (text, start, end, emphasis); prominences: strokes.prominence of each, accents within;
    sentences: (act, start, end).  Chance: 10 % of each pulse's height, 15 ms of its time."""
    pulses = {name: [] for name in AU_NAMES + ANGLES}
    for (text, start, end, _), strength, accent in zip(words, prominences, prosody.accent):
        scale, late = 1 + np.clip(0.1 * rng.normal(), -0.2, 0.2), 0.015 * rng.normal()
        _add_word(pulses, text, start + late, end, strength * scale, accent)
    states = {name: [] for name in AU_NAMES + ANGLES}
    for act, start, end in sentences:
        for name, height in _SENTENCES.get(act, {}).items():
            states[name].append((start, end, height))
    tones = prosody.at("contour", times)
    units = np.stack([bumps(times, pulses[name]) + plateaus(times, states[name])
                      for name in AU_NAMES], axis=1)
    units[:, :2] += 0.28 * np.clip(tones, 0, 6)[:, None]
    units = _BASE + style.face * units + 0.04 * rng.normal(size=units.shape)
    angles = np.stack([bumps(times, pulses[name]) + plateaus(times, states[name], 0.45)
                       for name in ANGLES], axis=1)
    angles[:, 0] -= 0.018 * np.clip(tones, -5, 5)
    angles = style.head * angles + 0.006 * _drift(times, rng)
    return np.clip(_HIGHEST * np.tanh(units / _HIGHEST), 0, 5), angles


def _add_word(pulses, text, start, end, strength, accent):
    name, _, shape = lexicon.look_up(text)
    if strength <= 0:
        return
    lasting = float(np.clip(end - start + 0.25, 0.45, 0.9))
    heights = dict(_WORD_PULSES.get(name, {}))
    for unit, height in _ACCENT.items():
        heights[unit] = heights.get(unit, 0) + height * (0.25 + 0.75 * accent)
    for unit, height in heights.items():
        pulses[unit].append((start, lasting, height * strength))
    if name in _SHAKES:
        side = 1
        for n in range(3):
            pulses["Ry"].append((start + 0.16 * n, 0.32, 0.26 * side * strength))
            side = -side
    elif name in _NODS:
        for n in range(2):
            pulses["Rx"].append((start + 0.28 * n, 0.36, 0.24 * strength))
    else:
        pulses["Rx"].append((start, lasting, (0.08 + 0.18 * accent) * strength))
    if shape in _TURNS:
        side = 1 if lexicon.fraction("side " + text.lower().strip(".,?!")) < 0.5 else -1
        pulses["Ry"].append((start, lasting + 0.3, side * _TURNS[shape] * strength))
    if shape in ("open", "narrow", "temple"):
        pulses["Rz"].append((start, lasting + 0.2, 0.18 * strength))


def _drift(times, rng):
    """(frames, 3): slow and of deviation 1."""
    frequencies, phases = rng.uniform(0.05, 0.4, (3, 3)), rng.uniform(0, 2 * np.pi, (3, 3))
    waves = np.sin(2 * np.pi * frequencies[None] * times[:, None, None] + phases[None])
    return waves.sum(axis=2) / np.sqrt(1.5)


def blinks(words, rng):
    """Times at which the eyes close: in pauses, and at least every six seconds or so."""
    found, last = [], 0.0
    for (_, _, end, _), (_, start, _, _) in zip(words, words[1:]):
        chance = rng.random()
        if (start - end > 0.25 and chance < 0.8) or end - last > 5 + 2 * chance:
            found.append(end + 0.05)
            last = end
    return found
