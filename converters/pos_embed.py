"""Fits published vision and audio checkpoints to AST's patch grid (Gong et al. 2021, section 2.2).

Recognised by the shapes: DeiT-384's 24 x 24 position embeddings, the AudioSet checkpoint's
12 x 101, and DeiT's patch convolution over three colours.
"""

import numpy as np

from .kinds.ast import patch_grid

DEIT_GRID = (24, 24)
AUDIOSET_GRID = (12, 101)


def adapt_ast(arrays, prefix, config, report):
    """Replaces, in `arrays`, what does not fit the geometry of `config`; the rest is left alone."""
    weight = prefix + "v.patch_embed.proj.weight"
    patch, d = config["patch"], config["d_model"]
    if weight in arrays and arrays[weight].shape == (d, 3, patch, patch):
        arrays[weight] = arrays[weight].astype(np.float32).sum(1, keepdims=True)
        report.append(f"{weight}: three colours summed to one channel")

    key, grid = prefix + "v.pos_embed", patch_grid(config)
    if key not in arrays or arrays[key].ndim != 3 or arrays[key].shape[::2] != (1, d):
        return
    rows = arrays[key].shape[1] - 2
    for found in (DEIT_GRID, AUDIOSET_GRID):
        if rows == found[0] * found[1] and grid != found:
            arrays[key] = adapt_positions(arrays[key].astype(np.float32), found, grid)
            report.append(f"{key}: {found[0]} x {found[1]} patches adapted to "
                          f"{grid[0]} x {grid[1]}")


def adapt_positions(positions, found, grid):
    """(1, 2 + found, D) -> (1, 2 + grid, D), the rows of both tokens as they are.

    Time first, then frequency, as the published code does: an axis is cut around its middle when it
    is long enough and stretched otherwise.
    """
    tokens, patches = positions[0, :2], positions[0, 2:].reshape(*found, -1)
    for axis in (1, 0):
        patches = _fit(patches, axis, grid[axis])
    return np.concatenate([tokens, patches.reshape(grid[0] * grid[1], -1)])[None]


def _fit(x, axis, size):
    if size <= x.shape[axis]:
        begin = x.shape[axis] // 2 - size // 2
        return np.take(x, range(begin, begin + size), axis)
    return _stretch(x, axis, size)


def _stretch(x, axis, size):
    """Linear interpolation along one axis with half-pixel centres (align_corners=False)."""
    length = x.shape[axis]
    at = np.clip((np.arange(size) + 0.5) * (length / size) - 0.5, 0, None)
    low = np.minimum(at.astype(int), length - 1)
    high = np.minimum(low + 1, length - 1)
    shape = [1] * x.ndim
    shape[axis] = size
    weight = (at - low).astype(np.float32).reshape(shape)
    return np.take(x, low, axis) * (1 - weight) + np.take(x, high, axis) * weight
