"""What several reference networks share: taps, normalisation, sinusoidal positions."""

import torch


def no_tap(name, value):
    """The tap of a run that nobody watches."""


def scoped(tap, scope):
    """A tap that puts `scope` in front of every name."""
    return lambda name, value: tap(f"{scope}/{name}", value)


class Normalisation:
    """x' = (x - mean) / (divisor * deviation); without statistics x' = x."""

    def __init__(self, statistics=None):
        s = statistics or {"mean": [0.0], "deviation": [1.0], "divisor": 1.0}
        self.mean = torch.tensor(s["mean"], dtype=torch.float64)
        self.scale = torch.tensor(s["deviation"], dtype=torch.float64) * s["divisor"]

    def apply(self, x):
        return (x - self.mean.to(x.dtype)) / self.scale.to(x.dtype)

    def undo(self, x):
        return x * self.scale.to(x.dtype) + self.mean.to(x.dtype)


def normalisation_of(network, stream):
    for statistics in network.get("normalisations", []):
        if statistics["stream"] == stream:
            return Normalisation(statistics)
    return Normalisation()


def sinusoidal_positions(length, d):
    """Vaswani et al. 2017, section 3.5, sine and cosine interleaved: (length, d)."""
    position = torch.arange(length, dtype=torch.float64)[:, None]
    column = torch.arange(d, dtype=torch.float64)[None, :]
    even = torch.floor(column / 2) * 2
    angle = position / 10000.0 ** (even / d)
    return torch.where(column == even, torch.sin(angle), torch.cos(angle))


def causal_mask(rows):
    """True where row i must not see row j > i."""
    return torch.ones(rows, rows, dtype=torch.bool).triu(1)
