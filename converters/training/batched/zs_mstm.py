"""ZS-MSTM 1.0 and 2.0 (converters/reference/zs_mstm*.py) on a batch of windows.

A window is what attends to itself: one segment, or `context_segments` of them.
"""

import torch

from ...reference.blocks import causal_mask, sinusoidal_positions
from . import ast, recurrent


def content(encoders, speech, text):
    """speech (B, W * T, F), text (B, W * T, d_text) -> h_content (B, rows, d_att)."""
    frames = encoders.c["frames"]
    batch, windows = len(speech), speech.shape[1] // frames
    x = encoders.speech.apply(speech).reshape(batch * windows, frames, -1)
    e_speech = ast.forward(encoders.ast_content, x).reshape(batch, windows, -1)
    x_text = rows_of_text(encoders, text)
    repeats = x_text.shape[1] // windows
    return attend(encoders.content_attention,
                  torch.cat([e_speech.repeat_interleave(repeats, 1), x_text], 2))


def style(encoders, speech, text):
    """sa([X_text, E_speech]) of clips of one segment (B, T, ...), pooled: (B, d_att)."""
    own = encoders.ast_content if encoders.c["ast_shared"] else encoders.ast_style
    e_speech = ast.forward(own, encoders.speech.apply(speech))
    x_text = rows_of_text(encoders, text)
    rows = torch.cat([x_text, e_speech[:, None].expand(-1, x_text.shape[1], -1)], 2)
    sa = attend(encoders.style_attention, rows)
    return {"Mean": sa.mean(1), "First": sa[:, 0], "Last": sa[:, -1]}[encoders.c["style_pool"]]


def rows_of_text(encoders, text):
    x = encoders.text.apply(text)
    if encoders.c["granularity"] == "Frame":
        return x
    return x.reshape(len(x), -1, encoders.c["frames"], x.shape[2]).mean(2)


def attend(attention, x):
    x = x.transpose(0, 1)
    return attention(x, x, x, need_weights=False)[0].transpose(0, 1)


def style_of_clips(network, clips):
    """h_style (B, d_style) of clips: speech, text, pose (B, S, T, columns), for 2.0 also face and
    tags (B, S, 38); the mean over the S segments, as the engine takes it."""
    batch, segments = clips["pose"].shape[:2]
    one = {name: x.flatten(0, 1) for name, x in clips.items()}
    parts = [style(network.encoders, one["speech"], one["text"]),
             recurrent.last_hidden(network.pose_lstm, network.pose.apply(one["pose"]))]
    if hasattr(network, "face_lstm"):
        parts += [recurrent.last_hidden(network.face_lstm, network.face.apply(one["face"])),
                  one["tags"]]
    return torch.cat(parts, 1).reshape(batch, segments, -1).mean(1)


def generate(generator, dense, h_content, h_style, before=None):
    """Normalised motion (B, W * T, columns); `before`, the true motion, is what an autoregressive
    decoder is taught with."""
    repeated = h_style[:, None].expand(-1, h_content.shape[1], -1)
    z = dense(torch.cat([h_content, repeated], 2))
    mode = generator.c["decoder_mode"]
    if mode == "Autoregressive":
        rows = before.reshape(len(z), z.shape[1], -1)
        target = generator.embedding(torch.cat([torch.zeros_like(rows[:, :1]), rows[:, :-1]], 1))
    elif mode == "ShiftedParallel":
        target = torch.cat([torch.zeros_like(z[:, :1]), z[:, :-1]], 1)
    else:
        target = z
    out = generator.head(_decode(generator, target, z))
    return out.reshape(len(z), -1, generator.columns)


def _decode(generator, x, memory):
    if generator.c["positions"] == "Sinusoidal":
        x = x + sinusoidal_positions(*x.shape[1:]).to(x)
    x, memory = x.transpose(0, 1), memory.transpose(0, 1)
    mask = causal_mask(len(x)).to(x.device)
    for layer in generator.decoder.layers:
        x = layer(x, memory, tgt_mask=mask)
    return x.transpose(0, 1)


def generators(network):
    """{stream: (decoder, the Dense before it)} of either version."""
    if hasattr(network, "generator"):
        return {"pose": (network.generator, network.dense)}
    return {stream: (decoder, getattr(decoder, "dense", None) or network.dense)
            for stream, decoder in (("pose", network.pose_generator),
                                    ("face", network.face_generator))}
