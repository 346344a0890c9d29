"""LSTM encoders and decoders (converters/reference/recurrent.py) on a batch of sequences."""

import torch
from torch.nn import functional as F


def encode(encoder, x):
    """(B, L, columns) -> (B, L, 2 * second), or (B, 1, 2 * second) of the last step only."""
    x = F.leaky_relu(along_time(encoder.lstm1, x), encoder.alpha)
    x = along_time(encoder.lstm2, x)
    if not encoder.sequence:
        half = x.shape[2] // 2
        x = torch.cat([x[:, -1:, :half], x[:, :1, half:]], 2)
    return F.leaky_relu(x, encoder.alpha)


def decode(decoder, x):
    """(B, L, columns) -> (B, L, 2 * hidden)."""
    for layer in (decoder.lstm1, decoder.lstm2):
        x = F.leaky_relu(along_time(layer, x), decoder.alpha)
    return x


def along_time(lstm, x):
    """(B, L, columns) -> (B, L, rows of the LSTM's output)."""
    return lstm(x.transpose(0, 1))[0].transpose(0, 1)


def last_hidden(lstm, x):
    """h of the top layer after the last of the rows: (B, L, columns) -> (B, hidden)."""
    return lstm(x.transpose(0, 1))[1][0][-1]
