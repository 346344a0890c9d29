"""Audio Spectrogram Transformer (Gong, Chung, Glass 2021), E_speech of the thesis (6.5.1).

Module names give the keys of the published checkpoints, without their "module." prefix.
"""

import torch
from torch import nn
from torch.nn import functional as F

from ..kinds.ast import patch_grid
from .blocks import no_tap, normalisation_of


class Attention(nn.Module):
    def __init__(self, d, heads):
        super().__init__()
        self.heads = heads
        self.qkv = nn.Linear(d, 3 * d)
        self.proj = nn.Linear(d, d)

    def forward(self, x):  # (N, D)
        n, d = x.shape
        q, k, v = self.qkv(x).reshape(n, 3, self.heads, d // self.heads).permute(1, 2, 0, 3)
        scores = q @ k.transpose(1, 2) * (d // self.heads) ** -0.5  # (heads, N, N)
        return self.proj((scores.softmax(-1) @ v).transpose(0, 1).reshape(n, d))


class Mlp(nn.Module):
    def __init__(self, d, d_mlp):
        super().__init__()
        self.fc1 = nn.Linear(d, d_mlp)
        self.fc2 = nn.Linear(d_mlp, d)

    def forward(self, x):
        return self.fc2(F.gelu(self.fc1(x)))  # GELU with erf


class Block(nn.Module):
    """Pre-norm encoder block (Dosovitskiy et al. 2021, eq. 2 and 3)."""

    def __init__(self, c):
        super().__init__()
        d = c["d_model"]
        self.norm1 = nn.LayerNorm(d, eps=c["ln_eps"])
        self.attn = Attention(d, c["heads"])
        self.norm2 = nn.LayerNorm(d, eps=c["ln_eps"])
        self.mlp = Mlp(d, c["d_mlp"])

    def forward(self, x):
        x = x + self.attn(self.norm1(x))
        return x + self.mlp(self.norm2(x))


class PatchEmbed(nn.Module):
    def __init__(self, c):
        super().__init__()
        self.proj = nn.Conv2d(1, c["d_model"], kernel_size=c["patch"], stride=c["stride"])

    def forward(self, x):  # (T, F)
        image = x.t()[None]  # one channel of F rows and T columns
        return self.proj(image).flatten(1).t()  # (f * t, D), frequency outermost


class Trunk(nn.Module):
    """The vision transformer inside AST; returns the two tokens in front of the patches."""

    def __init__(self, c):
        super().__init__()
        d = c["d_model"]
        f, t = patch_grid(c)
        self.cls_token = nn.Parameter(torch.zeros(1, 1, d))
        self.dist_token = nn.Parameter(torch.zeros(1, 1, d))
        self.pos_embed = nn.Parameter(torch.zeros(1, 2 + f * t, d))
        self.patch_embed = PatchEmbed(c)
        self.blocks = nn.ModuleList(Block(c) for _ in range(c["layers"]))
        self.norm = nn.LayerNorm(d, eps=c["ln_eps"])

    def forward(self, x, tap):
        patches = self.patch_embed(x)
        tap("patches", patches)
        x = torch.cat([self.cls_token[0], self.dist_token[0], patches]) + self.pos_embed[0]
        for n, block in enumerate(self.blocks):
            x = block(x)
            # Nothing but the two tokens is used of the last block; the engine leaves the rest out.
            tap(f"block.{n}/out", x if n + 1 < len(self.blocks) else x[:2])
        x = self.norm(x)[:2]
        tap("norm", x)
        return x


class Ast(nn.Module):
    def __init__(self, c):
        super().__init__()
        self.pool = c["pool"]
        self.v = Trunk(c)
        first = (nn.LayerNorm(c["d_model"], eps=c["head_ln_eps"])
                 if c["head"] == "LayerNormLinear" else nn.Identity())
        if c["head"] != "None":
            self.mlp_head = nn.Sequential(first, nn.Linear(c["d_model"], c["d_out"]))
        else:
            self.mlp_head = nn.Identity()

    def forward(self, x, tap=no_tap):  # (T, F) -> (1, d_out)
        tokens = self.v(x, tap)
        pooled = tokens[:1] if self.pool == "Cls" else tokens.mean(0, keepdim=True)
        out = self.mlp_head(pooled)
        tap("out", out)
        return out


class Network(nn.Module):
    """AST on its own, with its normalisation: speech (T, F) -> embedding (d_out)."""

    inputs = ("speech",)
    output = "embedding"

    def __init__(self, network):
        super().__init__()
        self.ast = Ast(network["config"])
        self.speech = normalisation_of(network, "speech")

    def weights(self):
        return self.ast

    def forward(self, arrays, tap=no_tap):
        named = lambda name, value: tap(f"ast/{name}", value)
        return {"embedding": self.ast(self.speech.apply(arrays["speech"]), named)[0]}
