"""Model 2 (thesis 5.6.1, 5.6.2), decoded the naive way: every step runs the whole prefix again."""

import torch
from torch import nn
from torch.nn import functional as F

from ..channels import tokens_of
from ..kinds.model2 import adds_text, stacks
from .blocks import causal_mask, no_tap, normalisation_of, sinusoidal_positions
from .sampling import Sampler, greedy
from .tokens import face_of, lengths_of

START = 1


class Attention(nn.Module):
    """Multi-head attention (eq. 5.10 to 5.12) with biases and an output projection."""

    def __init__(self, c, heads, memory=None):
        super().__init__()
        d, self.heads = c["d_model"], heads
        self.scale = 1.0 if c["scale"] == "None" else (d // heads) ** -0.5
        self.query, self.out = nn.Linear(d, d), nn.Linear(d, d)
        self.key, self.value = (nn.Linear(memory or d, d) for _ in range(2))

    def forward(self, x, memory, mask=None):
        q, k, v = (y.reshape(len(y), self.heads, -1).transpose(0, 1)
                   for y in (self.query(x), self.key(memory), self.value(memory)))
        scores = self.scale * q @ k.transpose(1, 2)  # (heads, rows of x, rows of memory)
        if mask is not None:
            scores = scores.masked_fill(mask, float("-inf"))
        return self.out((scores.softmax(-1) @ v).transpose(0, 1).reshape(len(x), -1))


class EncoderLayer(nn.Module):
    """Post-norm (Vaswani et al. 2017)."""

    def __init__(self, c):
        super().__init__()
        d = c["d_model"]
        self.self_attn = Attention(c, c["encoder_heads"])
        self.norm1, self.norm2 = (nn.LayerNorm(d, eps=c["ln_eps"]) for _ in range(2))
        self.linear1, self.linear2 = nn.Linear(d, c["encoder_ff"]), nn.Linear(c["encoder_ff"], d)

    def forward(self, x):
        x = self.norm1(x + self.self_attn(x, x))
        return self.norm2(x + self.linear2(F.relu(self.linear1(x))))


class DecoderLayer(nn.Module):
    """Post-norm, causal, with a sub-layer that attends to `memory` columns."""

    def __init__(self, c, heads, ff, memory):
        super().__init__()
        d = c["d_model"]
        self.self_attn, self.cross_attn = Attention(c, heads), Attention(c, heads, memory)
        self.norm1, self.norm3 = (nn.LayerNorm(d, eps=c["ln_eps"]) for _ in range(2))
        self.norm2 = None if c["shared_norm"] else nn.LayerNorm(d, eps=c["ln_eps"])
        self.linear1, self.linear2 = nn.Linear(d, ff), nn.Linear(ff, d)

    def forward(self, x, memory):
        x = self.norm1(x + self.self_attn(x, x, causal_mask(len(x))))
        x = (self.norm2 or self.norm1)(x + self.cross_attn(x, memory))
        return self.norm3(x + self.linear2(F.relu(self.linear1(x))))


class Convolutions(nn.ModuleList):
    """Conv1d, 'same', ReLU: (rows, columns) -> (rows, d_model)."""

    def __init__(self, c, columns):
        d, kernel = c["d_model"], c["kernel"]
        super().__init__(nn.Conv1d(d if n else columns, d, kernel, padding=kernel // 2)
                         for n in range(c["convolutions"]))

    def forward(self, x):
        x = x.t()[None]
        for layer in self:
            x = F.relu(layer(x))
        return x[0].t()


class CrossModality(nn.Module):
    """A: the master asks, the slave answers (eq. 5.12 inside a decoder layer)."""

    def __init__(self, c):
        super().__init__()
        self.master = c["master"]
        if self.master == "Text":
            self.text_projection = nn.Linear(c["d_text"], c["d_model"])
        slave = c["d_model"] if self.master == "Text" else c["d_text"]
        self.layer = DecoderLayer(c, c["attention_heads"], c["attention_ff"], slave)
        self.output = nn.Linear(c["d_model"], c["d_text"]) if adds_text(c) else None

    def forward(self, speech, text):  # (W, L, d), (W, d_text) -> H_att
        rows = speech.flatten(0, 1)
        if self.master == "Speech":
            # A word's text stands at each of its f0 values, as in the released code.
            return self.layer(rows, text.repeat_interleave(speech.shape[1], 0))
        x = self.layer(self.text_projection(text), rows)
        return x if self.output is None else text + self.output(x)


class DecoderStack(nn.Module):
    """D2_face: tokens (t,) -> (t, d_model)."""

    def __init__(self, c, channel):
        super().__init__()
        self.embedding = nn.Embedding(tokens_of(channel), c["d_model"])
        self.layers = nn.ModuleList(
            DecoderLayer(c, c["decoder_heads"], c["decoder_ff"], c["attention_width"])
            for _ in range(c["decoder_layers"]))

    def forward(self, tokens, memory):
        x = with_positions(self.embedding(tokens))
        for layer in self.layers:
            x = layer(x, memory)
        return x


def with_positions(x):
    """* sqrt(d), then sinusoidal positions."""
    return x * x.shape[1] ** 0.5 + sinusoidal_positions(*x.shape).to(x.dtype)


class Network(nn.Module):
    """f0 (words, L), text (words, d_text) -> tokens and face (windows, max_out, channels), and
    lengths (windows, channels) of the sequences.  A window is an inter-pausal unit of max_words."""

    output = "face"

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        d, channels = c["d_model"], c["channels"]
        self.text = normalisation_of(network, "text")
        self.f0_encoder = nn.ModuleDict({"embedding": nn.Embedding(c["f0_tokens"], d),
                                         "conv": Convolutions(c, d)})
        self.encoder = nn.ModuleDict(
            {"layers": nn.ModuleList(EncoderLayer(c) for _ in range(c["encoder_layers"]))})
        self.cross = CrossModality(c)
        self.decoders = nn.ModuleList(DecoderStack(c, first) for first in stacks(channels))
        if c["conv_decoder"]:
            self.conv_decoder = Convolutions(c, len(channels) * d)
        self.heads = nn.ModuleList(nn.Linear(d, tokens_of(channel)) for channel in channels)

    def weights(self):
        return self

    def forward(self, arrays, tap=no_tap, **sampling):
        pick = Sampler(**sampling) if sampling else greedy
        window, f0, text = self.c["max_words"], arrays["f0"], arrays["text"]
        missing = -len(f0) % window  # words of a last, partial window, all zero
        f0, text = (F.pad(x, (0, 0, 0, missing)) for x in (f0, text))
        tokens = [self.window(*words, pick, tap)
                  for words in zip(f0.split(window), text.split(window))]
        return {"tokens": torch.stack(tokens),
                "face": face_of(torch.stack(tokens), self.c["channels"]),
                "lengths": torch.stack([lengths_of(t) for t in tokens])}

    def window(self, f0, text, pick, tap):
        h_att = self.cross(self.speech(f0, tap), self.text.apply(text))
        tap("cross/out", h_att)
        return self.decode(h_att, pick, tap)

    def speech(self, f0, tap):
        """X_speech of every word by itself: (W, L) -> (W, L, d), eq. 5.8 and 5.9."""
        words = torch.stack([with_positions(self.f0_encoder["conv"](x))
                             for x in self.f0_encoder["embedding"](self.f0_ids(f0))])
        tap("f0_encoder/out", words.flatten(0, 1))
        for n, layer in enumerate(self.encoder["layers"]):
            words = torch.stack([layer(x) for x in words])
            tap(f"encoder.{n}/out", words.flatten(0, 1))
        return words

    def f0_ids(self, f0):
        """Nearest level; 0 where there is no voice."""
        ids = torch.floor((f0.double() - self.c["f0_minimum"]) / self.c["f0_step"] + 0.5).long()
        return torch.where(f0 > 0, ids.clamp(1, self.c["f0_tokens"] - 1), 0)

    def decode(self, h_att, pick, tap):
        """All sequences grow by one token a step: (max_out, channels)."""
        channels = self.c["channels"]
        tokens = torch.full((1, len(channels)), START)
        picked_from = [[] for _ in channels]
        for _ in range(self.c["max_out"]):
            logits = self.logits(tokens, h_att)
            for channel, x in zip(picked_from, logits):
                channel.append(x)
            tokens = torch.cat([tokens, torch.tensor([[pick(x) for x in logits]])])
        for n, rows in enumerate(picked_from):
            tap(f"logits.{n}", torch.stack(rows))
        return tokens[1:]

    def logits(self, tokens, h_att):
        """Of each channel's next token, after the prefixes (t, channels)."""
        outputs = [self.decoders[channel["stack"]](prefix, h_att)
                   for channel, prefix in zip(self.c["channels"], tokens.t())]
        if self.c["conv_decoder"]:
            # 'same' on the prefix: rows that are not decoded yet are zero, at every layer.
            outputs = [self.conv_decoder(torch.cat(outputs, 1))] * len(outputs)
        return [head(rows[-1]) for head, rows in zip(self.heads, outputs)]
