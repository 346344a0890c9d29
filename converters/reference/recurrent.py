"""Encoders and decoders of two LSTM layers (thesis 5.5), as Keras has their layers."""

import torch
from torch import nn
from torch.nn import functional as F

from .blocks import no_tap


def last_step(rows):
    """(L, 2H) of a bidirectional LSTM -> (1, 2H): Keras' last output joins what each direction
    knows after reading everything, which backwards is at row 0."""
    hidden = rows.shape[1] // 2
    return torch.cat([rows[-1:, :hidden], rows[:1, hidden:]], 1)


class Encoder(nn.Module):
    """(L, columns) -> (L, 2 * second), or (1, 2 * second) of the last step only."""

    def __init__(self, columns, first, second, alpha, sequence):
        super().__init__()
        self.alpha, self.sequence = alpha, sequence
        self.lstm1 = nn.LSTM(columns, first, bidirectional=True)
        self.lstm2 = nn.LSTM(2 * first, second, bidirectional=True)

    def forward(self, x, tap=no_tap):
        x = F.leaky_relu(self.lstm1(x)[0], self.alpha)
        tap("lstm1", x)
        x = self.lstm2(x)[0]
        x = F.leaky_relu(x if self.sequence else last_step(x), self.alpha)
        tap("code", x)
        return x


class Decoder(nn.Module):
    """(L, columns) -> (L, 2 * hidden)."""

    def __init__(self, columns, hidden, alpha):
        super().__init__()
        self.alpha = alpha
        self.lstm1 = nn.LSTM(columns, hidden)
        self.lstm2 = nn.LSTM(hidden, 2 * hidden)

    def forward(self, x, tap=no_tap):
        for name, layer in (("lstm1", self.lstm1), ("lstm2", self.lstm2)):
            x = F.leaky_relu(layer(x)[0], self.alpha)
            tap(name, x)
        return x
