"""Predicted sequences of face and head and their quantisation (thesis 5.3 and features.md, 2.3)."""

from .checks import expect, positive

# Tokens before level 0: padding, start and end of a sequence.
SPECIAL = 3

_AUS = ("AU01", "AU02", "AU04", "AU05", "AU06", "AU07")
# Name, least value and levels; the thesis' steps.  The ranges, those of its training data, are not
# published.
_ROTATIONS = (("Rx", -0.6, 0.003, 400), ("Ry", -0.4, 0.002, 400), ("Rz", -0.4, 0.004, 200))


def default_channels():
    """Six action units and three head rotations, each in a decoder stack of its own."""
    channels = [{"name": name, "unit": "intensity 0 to 5", "minimum": 0.0, "step": 0.01,
                 "levels": 500} for name in _AUS]
    channels += [{"name": name, "unit": "rad", "minimum": minimum, "step": step, "levels": levels}
                 for name, minimum, step, levels in _ROTATIONS]
    return [{**channel, "stack": stack} for stack, channel in enumerate(channels)]


def tokens_of(channel):
    """Size of a channel's vocabulary."""
    return SPECIAL + channel["levels"]


def check_channels(c):
    channels = c["channels"]
    expect(channels, "config", "channels", "none", "at least one")
    names = [channel["name"] for channel in channels]
    for channel in channels:
        where = f"config.channels.{channel['name']}"
        expect(names.count(channel["name"]) == 1, where, "name", "used twice", "once")
        positive(channel, where, "levels")
        expect(channel["step"] > 0, where, "step", channel["step"], "above zero")
