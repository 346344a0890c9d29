"""Where attention starts from.  As PyTorch draws it, every row sees the mean of all rows, and small
networks spend most of a short training on learning that rows differ."""

import math

import torch


def attend_to_yourself(attention, gain=2.5):
    """Eq. 6.1, which has no residual, as a soft look-up of each row itself."""
    d = attention.embed_dim
    with torch.no_grad():
        look, value = (torch.nn.init.orthogonal_(torch.empty(d, d)) for _ in range(2))
        attention.in_proj_weight.copy_(torch.cat([gain * look, gain * look, value]))
        attention.out_proj.weight.copy_(value.t())


def look_back(attention, offsets, gain=1.5):
    """Head n of a self-attention whose rows have sinusoidal positions looks `offsets[n]` rows back:
    the scores are gain^2 times a sum of cosines of the distance to there."""
    d, width = attention.embed_dim, attention.head_dim
    pairs = width // 2
    with torch.no_grad():
        for head, offset in enumerate(offsets):
            rows = torch.zeros(2, width, d)
            for n in range(pairs):
                pair = n * min(d // 4, 32) // pairs  # the fast half: these tell neighbours apart
                angle = offset * 10000.0 ** (-2.0 * pair / d)
                cos, sin = math.cos(angle), math.sin(angle)
                rows[0, 2 * n:2 * n + 2, 2 * pair:2 * pair + 2] = torch.eye(2)
                # (sin, cos) of j turned on to those of j + offset.
                rows[1, 2 * n:2 * n + 2, 2 * pair:2 * pair + 2] = torch.tensor([[cos, sin],
                                                                                [-sin, cos]])
            for part in range(2):
                begin = part * d + head * width
                attention.in_proj_weight[begin:begin + width] = gain * rows[part]


def offsets(layer, heads):
    """Different distances for each head of each layer, denser close by: 1, 2, 4, 6, 9, 12, ..."""
    return [(n + 2) ** 2 // 4 for n in range(layer, layer + 3 * heads, 3)][:heads]
