"""AST (converters/reference/ast.py) on a batch of segments."""

import torch


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
    for block in trunk.blocks:
        x = x + _attention(block.attn, block.norm1(x))
        x = x + block.mlp(block.norm2(x))
    return trunk.norm(x[:, :2])


def _attention(attention, x):
    batch, n, d = x.shape
    qkv = attention.qkv(x).reshape(batch, n, 3, attention.heads, d // attention.heads)
    q, k, v = qkv.permute(2, 0, 3, 1, 4)  # each (B, heads, N, d / heads)
    scores = q @ k.transpose(2, 3) * (d // attention.heads) ** -0.5
    return attention.proj((scores.softmax(-1) @ v).transpose(1, 2).reshape(batch, n, d))
