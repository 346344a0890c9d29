"""Curves of movement: minimum-jerk steps and bumps, added where they overlap (Flash and Hogan 1985;
Flash and Henis 1991), so that every movement is smooth whenever the next one begins."""

import numpy as np


def step(x):
    """0 for x <= 0, 1 for x >= 1, minimum jerk between."""
    x = np.clip(x, 0, 1)
    return x**3 * (10 - 15 * x + 6 * x * x)


def bump(x):
    """0 outside (0, 1), 1 in its middle, smooth."""
    x = np.clip(x, 0, 1)
    return 64 * (x * (1 - x))**3


def moves(times, start, targets):
    """(frames, columns): from `start` to one target after another.

    targets: [(time, duration, (columns,))] in the order of time.  A move that begins before the
    last one has ended is added to it."""
    start = np.asarray(start, float)
    curve = np.tile(start, (len(times), 1))
    before = start
    for begin, duration, target in targets:
        target = np.asarray(target, float)
        curve += step((times - begin) / duration)[:, None] * (target - before)
        before = target
    return curve


def bumps(times, found):
    """(frames,): sum of [(time, duration, height)]"""
    curve = np.zeros(len(times))
    for begin, duration, height in found:
        curve += height * bump((times - begin) / duration)
    return curve


def plateaus(times, found, rise=0.35):
    """(frames,): sum of [(begin, end, height)], each reached and left in `rise` seconds."""
    curve = np.zeros(len(times))
    for begin, end, height in found:
        curve += height * (step((times - begin) / rise) - step((times - end) / rise))
    return curve
