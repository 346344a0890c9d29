"""Classifier C of transfer strength (thesis 7.5.1)."""

import torch
from torch import nn

from .blocks import no_tap, normalisation_of


class Network(nn.Module):
    """motion (segments * T, d_in) -> strength (segments,): above one half, it is the target's."""

    output = "strength"

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        self.motion = normalisation_of(network, "motion")
        self.lstm = nn.LSTM(c["d_in"], c["hidden"], c["layers"])
        self.dense = nn.Linear(c["hidden"], 1)

    def weights(self):
        return self

    def forward(self, arrays, tap=no_tap):
        strengths = []
        for motion in arrays["motion"].split(self.c["frames"]):
            rows = self.lstm(self.motion.apply(motion))[0]
            tap("lstm", rows)
            strengths.append(self.dense(rows[-1]).sigmoid())
        return {"strength": torch.cat(strengths)}
