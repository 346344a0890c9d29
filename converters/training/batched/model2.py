"""Model 2 (converters/reference/model2.py) on a batch of windows, taught with the true tokens."""

import torch
from torch.nn import functional as F

from ...reference.blocks import causal_mask, sinusoidal_positions


def logits(network, f0, text, tokens, drop=0.0):
    """f0 (B, W, L) Hz, text (B, W, d_text), tokens (B, t, channels) before each step -> for each
    channel (B, t, tokens).  `drop` is applied to what the thesis says (5.6.2)."""
    memory = h_att(network, f0, text, drop)
    outputs = [_stack(network.decoders[channel["stack"]], tokens[:, :, n], memory, drop)
               for n, channel in enumerate(network.c["channels"])]
    if network.c["conv_decoder"]:
        outputs = [newest_rows(network.conv_decoder, torch.cat(outputs, 2))] * len(outputs)
    return [head(rows) for head, rows in zip(network.heads, outputs)]


def h_att(network, f0, text, drop=0.0):
    """(B, rows, attention_width)."""
    speech = _speech(network, f0, drop)
    text = network.text.apply(text)
    cross = network.cross
    if cross.master == "Speech":
        return _layer(cross.layer, speech, text.repeat_interleave(f0.shape[2], 1), drop)
    x = _layer(cross.layer, cross.text_projection(text), speech, drop)
    return x if cross.output is None else text + cross.output(x)


def _speech(network, f0, drop):
    """X_speech of all words, their values behind one another: (B, W * L, d).  Words without voice,
    with which windows are filled up, are all alike, so one of them is encoded for all."""
    words = network.f0_ids(f0).flatten(0, 1)
    voiced = (words > 0).any(1)
    x = torch.cat([words[voiced], torch.zeros_like(words[:1])])
    x = network.f0_encoder["embedding"](x)
    x = F.dropout(_with_positions(_convolve(network.f0_encoder["conv"], x)), drop)
    for layer in network.encoder["layers"]:
        x = layer.norm1(x + F.dropout(_attend(layer.self_attn, x, x), drop))
        x = layer.norm2(x + F.dropout(layer.linear2(F.relu(layer.linear1(x))), drop))
    place = torch.where(voiced, voiced.cumsum(0) - 1, len(x) - 1)
    return x[place].reshape(len(f0), -1, x.shape[2])


def newest_rows(convolutions, x):
    """(B, t, columns) -> (B, t, d): row i as the last of the prefix 0..i, which is zero-padded at
    both ends at every layer.  It needs the few rows before i, so each row gets them as a window."""
    batch, steps, _ = x.shape
    first, *others = convolutions
    before = sum(layer.kernel_size[0] // 2 for layer in convolutions)
    # What the first layer does with each row is the same in all windows.
    rows = F.pad(_products(first, x), (0, 0, 0, 0, before, 0)).unfold(1, before + 1, 1)
    rows = rows.reshape(batch * steps, *rows.shape[2:]).permute(0, 3, 1, 2)
    exists = torch.arange(steps)[:, None] + torch.arange(before + 1) >= before
    exists = exists.repeat(batch, 1)[:, :, None].to(x)
    rows = F.relu(_sum(first, rows)) * exists
    for layer in others:
        rows = F.relu(_sum(layer, _products(layer, rows))) * exists
    return rows[:, -1].reshape(batch, steps, -1)


def _products(layer, x):
    """Of every row with each column of the kernel: (..., columns) -> (..., kernel, d)."""
    weight = layer.weight.permute(1, 2, 0)  # (columns, kernel, d)
    found = x.reshape(-1, x.shape[-1]) @ weight.flatten(1)
    return found.reshape(*x.shape[:-1], *weight.shape[1:])


def _sum(layer, products):
    """'same' convolution of their products: (N, rows, kernel, d) -> (N, rows, d)."""
    radius = layer.kernel_size[0] // 2
    return layer.bias + sum(_moved(x, n - radius) for n, x in enumerate(products.unbind(2)))


def _moved(x, rows):
    """Row i becomes row i + `rows` of x (N, rows, d), zero where there is none."""
    if rows < 0:
        return F.pad(x[:, :rows], (0, 0, -rows, 0))
    return F.pad(x[:, rows:], (0, 0, 0, rows))


def _stack(stack, tokens, memory, drop):
    x = F.dropout(_with_positions(stack.embedding(tokens)), drop)
    for layer in stack.layers:
        x = _layer(layer, x, memory, drop)
    return x


def _layer(layer, x, memory, drop):
    mask = causal_mask(x.shape[1]).to(x.device)
    x = layer.norm1(x + F.dropout(_attend(layer.self_attn, x, x, mask), drop))
    x = (layer.norm2 or layer.norm1)(x + F.dropout(_attend(layer.cross_attn, x, memory), drop))
    return layer.norm3(x + F.dropout(layer.linear2(F.relu(layer.linear1(x))), drop))


def _attend(attention, x, memory, mask=None):
    q, k, v = (y.reshape(len(y), y.shape[1], attention.heads, -1).transpose(1, 2)
               for y in (attention.query(x), attention.key(memory), attention.value(memory)))
    scores = attention.scale * q @ k.transpose(2, 3)
    if mask is not None:
        scores = scores.masked_fill(mask, float("-inf"))
    return attention.out((scores.softmax(-1) @ v).transpose(1, 2).flatten(2))


def _convolve(convolutions, x):
    x = x.transpose(1, 2)
    for layer in convolutions:
        x = F.relu(layer(x))
    return x.transpose(1, 2)


def _with_positions(x):
    """* sqrt(d), then sinusoidal positions."""
    return x * x.shape[2] ** 0.5 + sinusoidal_positions(*x.shape[1:]).to(x)
