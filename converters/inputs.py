"""Seeded numbers of plausible size for networks without recordings."""

import numpy as np


class Streams:
    """A source of numbers that knows the columns and the statistics of a network's streams."""

    def __init__(self, widths, normalisations, seed):
        self.rng = np.random.default_rng([seed, 1])
        self._widths = widths
        self._statistics = {n["stream"]: n for n in normalisations}

    def rows(self, name, rows):
        """(rows, columns) of a stream: half a slow movement, half noise, neither constant nor
        white along time."""
        return self.named(name, self.smooth(rows, self._widths[name]))

    def smooth(self, rows, width):
        steps = self.rng.standard_normal((rows // 8 + 2, width)).repeat(8, 0)[:rows]
        return np.sqrt(0.5) * (steps + self.rng.standard_normal((rows, width)))

    def named(self, name, x):
        """`x`, of mean 0 and deviation 1, in the units of the stream."""
        s = self._statistics.get(name)
        if s:
            x = x * np.array(s["deviation"]) + np.array(s["mean"])
        return x.astype(np.float32)

    def contours(self, words, length, low, high):
        """f0 (words, length) in Hz: a slow movement between `low` and `high`, and zeros from the
        end of a word on; the third of four words has no voice at all."""
        at = np.linspace(0, 1, length)
        centre, depth, turns, phase = self.rng.uniform(
            [[0.2], [0.1], [0.5], [0]], [[0.8], [0.5], [3], [2 * np.pi]], (4, words))[..., None]
        f0 = low + (high - low) * np.clip(
            centre + depth * np.sin(2 * np.pi * turns * at + phase), 0, 1)
        f0[np.arange(length) >= self.rng.integers((length + 1) // 2, length + 1, (words, 1))] = 0
        f0[2::4] = 0
        return f0.astype(np.float32)
