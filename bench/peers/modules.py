"""The reference networks of converters/reference as modules from tensors to tensors, which
torch.jit.trace and torch.onnx.export take.

A class is made of a completed network and arrays (key -> float32 array) for the tensors that
`needs` names, all of the network where it is empty, and gives `inputs(rng, size)`, name -> array,
in the order of forward's arguments.  Its parameters are double until the exporter says otherwise.
"""

import functools

import numpy as np
import torch
from torch import nn

from converters.channels import tokens_of
from converters.kinds.zs_mstm1 import d_content, d_style
from converters.reference import blocks, model2, recurrent, zs_mstm
from converters.reference.run import build


def fix_constants():
    """Makes positions and masks constants of what is traced: the peers know the length as well as
    gestus does, but would compute them again in every run."""
    for name in ("sinusoidal_positions", "causal_mask"):
        known = functools.lru_cache(maxsize=None)(getattr(blocks, name))

        def constant(*sizes, known=known):
            return known(*map(int, sizes)).clone()

        for module in (model2, zs_mstm):
            if hasattr(module, name):
                setattr(module, name, constant)


def _rows(rng, rows, columns):
    return rng.standard_normal((rows, columns), dtype=np.float32)


def _ids(rng, shape, end):
    return rng.integers(1, end, shape).astype(np.int32)


def _load(module, arrays, prefix=""):
    """`module` in double with the arrays behind `prefix`."""
    module = module.double().eval()
    module.load_state_dict({key[len(prefix):]: torch.from_numpy(array).double()
                            for key, array in arrays.items() if key.startswith(prefix)})
    return module


class Ast(nn.Module):
    """speech (frames, mel bins) -> embedding."""

    needs = ()

    def __init__(self, network, arrays):
        super().__init__()
        self.columns = network["config"]["mel_bins"]
        self.ast = build(network, arrays).ast

    def inputs(self, rng, size):
        return {"speech": _rows(rng, size, self.columns)}

    def forward(self, speech):
        return self.ast(speech)


class Bert(nn.Module):
    """ids (T,), [CLS] and [SEP] among them -> hidden (T, d)."""

    needs = ()

    def __init__(self, network, arrays):
        super().__init__()
        self.tokens = network["config"]["tokens"]
        whole = build(network, arrays)
        self.embeddings, self.layers = whole.embeddings, whole.encoder["layer"]

    def inputs(self, rng, size):
        return {"ids": _ids(rng, size, self.tokens)}

    def forward(self, ids):
        x = self.embeddings(ids.long())
        for layer in self.layers:
            x = layer(x)
        return x


class Lstm(nn.Module):
    """The LSTMs of the classifier: x (T, d_in) -> rows of the top layer (T, hidden)."""

    needs = ("lstm.",)

    def __init__(self, network, arrays):
        super().__init__()
        c = self.c = network["config"]
        self.lstm = _load(nn.LSTM(c["d_in"], c["hidden"], c["layers"]), arrays, "lstm.")

    def inputs(self, rng, size):
        return {"x": _rows(rng, size, self.c["d_in"])}

    def forward(self, x):
        return self.lstm(x)[0]


class BiLstm(nn.Module):
    """E_text of Model 1: text (T, d_text) -> h_text (1, 2 * hidden2)."""

    needs = ("e_text.",)

    def __init__(self, network, arrays):
        super().__init__()
        c = self.c = network["config"]
        encoder = recurrent.Encoder(c["d_text"], c["hidden1"], c["hidden2"], c["alpha"], False)
        self.e_text = _load(encoder, arrays, "e_text.")

    def inputs(self, rng, size):
        return {"text": _rows(rng, size, self.c["d_text"])}

    def forward(self, text):
        return self.e_text(text)


class Generator(nn.Module):
    """G of ZS-MSTM 1.0 with its dense layer: content (T, d_content), style (1, d_style) -> pose."""

    needs = ("dense.", "decoder.", "head.")

    def __init__(self, network, arrays):
        super().__init__()
        c = self.c = network["config"]
        self.generator = zs_mstm.Generator(c, c["d_pose"])
        self.generator.dense = nn.Linear(d_content(c) + d_style(c), c["d_model"])
        _load(self.generator, arrays)

    def inputs(self, rng, size):
        return {"content": _rows(rng, size, d_content(self.c)),
                "style": _rows(rng, 1, d_style(self.c))}

    def forward(self, content, style):
        x = torch.cat([content, style.expand(len(content), -1)], 1)
        return self.generator(self.generator.dense(x), blocks.no_tap)


class Model2(nn.Module):
    """f0 tokens of one word (f0_length,), text (W, d_text), tokens (channels, max_out) -> logits of
    every channel, the tokens before each position given (teacher forcing)."""

    needs = ()

    def __init__(self, network, arrays):
        super().__init__()
        self.c = network["config"]
        self.whole = build(network, arrays)

    def inputs(self, rng, size):
        c = self.c
        tokens = [_ids(rng, c["max_out"], tokens_of(channel)) for channel in c["channels"]]
        return {"f0": _ids(rng, c["f0_length"], c["f0_tokens"]),
                "text": _rows(rng, size, c["d_text"]), "tokens": np.stack(tokens)}

    def forward(self, f0, text, tokens):
        net = self.whole
        # As Network.speech, for one word whose values are tokens already.
        x = model2.with_positions(net.f0_encoder["conv"](net.f0_encoder["embedding"](f0.long())))
        for layer in net.encoder["layers"]:
            x = layer(x)
        h_att = net.cross(x[None], text)
        rows = [net.decoders[channel["stack"]](tokens[n].long(), h_att)
                for n, channel in enumerate(self.c["channels"])]
        rows = [net.conv_decoder(torch.cat(rows, 1))] * len(rows)
        return tuple(head(x) for head, x in zip(net.heads, rows))
