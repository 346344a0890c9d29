"""AST (converters/reference/ast.py) on a batch of segments."""

import torch
from torch.nn import functional as F


def forward(ast, x):
    """(B, T, F) -> (B, d_out)."""
    tokens = _trunk(ast.v, x)
    return ast.mlp_head(tokens[:, 0] if ast.pool == "Cls" else tokens.mean(1))


def initialise(ast):
    """Tokens and positions, which are zeros in a new module, as DeiT draws them."""
    for table in (ast.v.cls_token, ast.v.dist_token, ast.v.pos_embed):
        torch.nn.init.normal_(table, std=0.02)


def _trunk(trunk, x):
    patches = trunk.patch_embed.proj(x.transpose(1, 2)[:, None]).flatten(2).transpose(1, 2)
    front = torch.cat([trunk.cls_token, trunk.dist_token], 1).expand(len(x), -1, -1)
    x = torch.cat([front, patches], 1) + trunk.pos_embed
    for n, block in enumerate(trunk.blocks):
        # Nothing but the two tokens is used of the last block.
        rows = 2 if n + 1 == len(trunk.blocks) else x.shape[1]
        y = x[:, :rows] + _attention(block.attn, block.norm1(x), rows)
        x = y + block.mlp(block.norm2(y))
    return trunk.norm(x[:, :2])


def _attention(attention, x, rows):
    """Of the first `rows` rows of x (B, N, d) to all of them."""
    batch, _, d = x.shape
    q, kv = (F.linear(y, weight, bias) for y, weight, bias in zip(
        (x[:, :rows], x), attention.qkv.weight.split([d, 2 * d]),
        attention.qkv.bias.split([d, 2 * d])))
    q, k, v = (y.reshape(batch, y.shape[1], attention.heads, -1).transpose(1, 2)
               for y in (q, *kv.chunk(2, 2)))  # each (B, heads, rows, d / heads)
    scores = q @ k.transpose(2, 3) * (d // attention.heads) ** -0.5
    return attention.proj((scores.softmax(-1) @ v).transpose(1, 2).reshape(batch, rows, d))
