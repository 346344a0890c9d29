"""Model 1 (converters/reference/model1.py) on a batch of words."""

import torch

from . import recurrent


def logits(network, f0, text):
    """f0 (B, f0_length), text (B, text_rows, d_text) -> for each channel (B, out_length, tokens)."""
    x = recurrent.encode(network.e1_speech, network.f0.apply(f0[:, :, None]))
    h_speech = recurrent.encode(network.e2_speech, x.expand(-1, f0.shape[1], -1))
    h_text = recurrent.encode(network.e_text, network.text.apply(text))
    h = torch.cat([h_speech, h_text], 2).expand(-1, network.c["out_length"], -1)  # eq. 5.4
    return [head(recurrent.decode(d_face, h))
            for d_face, head in zip(network.d_face, network.heads)]
