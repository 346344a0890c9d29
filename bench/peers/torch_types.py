"""PyTorch's own ways to fewer bits, for modules of modules.py in float32."""

import copy

import torch
from torch import nn
from torch.nn import functional as F
from torch.ao.quantization import (default_dynamic_qconfig, per_channel_dynamic_qconfig,
                                   quantize_dynamic)


class _InBf16(nn.Module):
    """Everything in bf16 between float32 inputs and outputs."""

    def __init__(self, module):
        super().__init__()
        self.module = module.to(torch.bfloat16)

    def forward(self, *inputs):
        outputs = self.module(*(x.bfloat16() if x.is_floating_point() else x for x in inputs))
        return tuple(x.float() for x in outputs) if isinstance(outputs, tuple) else outputs.float()


class _SplitAttention(nn.Module):
    """nn.MultiheadAttention on (rows, d) as linear layers, which is what quantize_dynamic knows."""

    def __init__(self, attention):
        super().__init__()
        self.heads, d = attention.num_heads, attention.embed_dim
        weights, biases = attention.in_proj_weight.split(d), attention.in_proj_bias.split(d)
        self.query, self.key, self.value = (_linear(w, b) for w, b in zip(weights, biases))
        self.out = _linear(attention.out_proj.weight, attention.out_proj.bias)

    def forward(self, query, key, value, attn_mask=None, **_):
        q, k, v = (x.reshape(len(x), self.heads, -1).transpose(0, 1)
                   for x in (self.query(query), self.key(key), self.value(value)))
        scores = q @ k.transpose(1, 2) * q.shape[2] ** -0.5
        if attn_mask is not None:
            scores = scores.masked_fill(attn_mask, float("-inf"))
        return self.out((F.softmax(scores, -1) @ v).transpose(0, 1).flatten(1)), None


def _linear(weight, bias):
    linear = nn.Linear(weight.shape[1], weight.shape[0])
    linear.weight, linear.bias = nn.Parameter(weight.detach()), nn.Parameter(bias.detach())
    return linear


class _BatchedLstm(nn.Module):
    """nn.LSTM on (T, columns) as quantize_dynamic's own needs it, with a batch of one."""

    def __init__(self, lstm):
        super().__init__()
        self.lstm = lstm

    def forward(self, x):
        return self.lstm(x[:, None])[0][:, 0], None


_KNOWN = {nn.MultiheadAttention: _SplitAttention, nn.LSTM: _BatchedLstm}


def _make_known(module):
    for name, child in module.named_children():
        if type(child) in _KNOWN:
            setattr(module, name, _KNOWN[type(child)](child))
        else:
            _make_known(child)


def to_bf16(module):
    return _InBf16(module).eval()


def to_int8(module):
    """Dynamic quantisation, of linear layers by output channel."""
    module = copy.deepcopy(module).eval()
    _make_known(module)
    return quantize_dynamic(module, {nn.Linear: per_channel_dynamic_qconfig,
                                     nn.LSTM: default_dynamic_qconfig})


MAKERS = {"bf16": to_bf16, "int8": to_int8}
