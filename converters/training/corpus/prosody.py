"""What a gesturer hears: the pitch by the engine's SWIPE', loudness, and the accent of words."""

import dataclasses

import numpy as np

HOP = 0.01  # s


@dataclasses.dataclass(frozen=True)
class Prosody:
    """Every HOP: semitones above the median of the inter-pausal unit, 0 where unvoiced (smoothed);
    loudness, 0 to 1.  Of every word: accent, 0 to 1."""
    contour: np.ndarray
    loudness: np.ndarray
    accent: np.ndarray

    def at(self, name, times):
        values = getattr(self, name)
        return np.interp(times, np.arange(len(values)) * HOP, values)


def loudness(samples, rate):
    """0 at 40 dB below the loud parts (95 % of all), 1 there; every HOP, smoothed over 50 ms."""
    hop = int(rate * HOP)
    frames = samples[: len(samples) // hop * hop].reshape(-1, hop)
    level = 10 * np.log10(np.mean(frames**2, axis=1) + 1e-10)
    return smooth(np.clip(1 + (level - np.percentile(level, 95)) / 40, 0, 1), 5)


def smooth(values, width):
    """Mean of `width` values around each, the first and last repeated beyond the ends."""
    padded = np.pad(values, (width // 2, width - 1 - width // 2), mode="edge")
    return np.convolve(padded, np.ones(width) / width, mode="valid")


def hear(f0, level, words, units):
    """`f0` (n,) Hz every HOP, 0 unvoiced; `words`, `units`: (start, end) in seconds."""
    count = min(len(f0), len(level))
    f0, level = f0[:count], level[:count]
    tones = np.zeros(count)
    for span in units:
        part = slice(*_rows(span, count))
        voiced = f0[part] > 0
        if voiced.any():
            base = np.median(f0[part][voiced])
            tones[part][voiced] = np.clip(12 * np.log2(f0[part][voiced] / base), -12, 12)
            tones[part] = np.interp(np.arange(len(voiced)), np.flatnonzero(voiced),
                                    tones[part][voiced])
    accents = np.zeros(len(words))
    for n, span in enumerate(words):
        part = slice(*_rows(span, count))
        if part.stop > part.start:
            high, loud = np.percentile(tones[part], 90), np.percentile(level[part], 90)
            accents[n] = np.clip(high / 5, 0, 1) * 0.7 + np.clip((loud - 0.8) / 0.25, 0, 1) * 0.3
    return Prosody(smooth(tones, 15), level, accents)


def units_of(words, pause=0.2):
    """Spans of inter-pausal units (thesis 5.6.1)."""
    units = []
    for start, end in words:
        if units and start - units[-1][1] <= pause + 1e-6:
            units[-1] = (units[-1][0], end)
        else:
            units.append((start, end))
    return units


def _rows(span, count):
    first, last = (int(round(t / HOP)) for t in span)
    return min(first, count), min(max(last, first + 1), count)
