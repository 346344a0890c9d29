"""Random weights whose outputs are of order one and follow speech, text and style.

Fan-in scaling keeps every layer's signal at order one at full size and in the tiny geometries of
the tests alike.  Each tensor has its own stream of numbers, from the seed and its name.
"""

import zlib

import numpy as np

from . import shapes

# Factors on 1 / sqrt(fan in), by the end of a key's module path.  Queries and keys are large so
# that attention picks rows instead of averaging over all of them, which would leave the output
# constant along time.
_GAINS = {"multihead_attn.in_proj_weight": 3.0, "in_proj_weight": 2.0, "attn.qkv.weight": 1.3,
          "weight_ih_l": 2.5, "weight_hh_l": 1.5, "pose_embedding.weight": 0.5}


def random_weights(network, seed):
    """key -> float32 array for a completed network."""
    return {key: _tensor(key, shape, seed)
            for key, shape in shapes.network_shapes(network).items()}


def random_zs_mstm1(network, seed):
    """The PyTorch reference of `network` with these weights."""
    from .reference.run import build
    return build(network, random_weights(network, seed))


def save_checkpoint(path, tensors):
    """A checkpoint as torch.save writes it: a state_dict of `tensors`."""
    import torch
    torch.save({key: torch.from_numpy(array) for key, array in tensors.items()}, path)


def _tensor(key, shape, seed):
    rng = np.random.default_rng([seed, zlib.crc32(key.encode())])
    x = rng.standard_normal(shape, dtype=np.float32)
    if len(shape) == 1:
        norm = ".norm" in key or "mlp_head.0" in key
        return np.float32(0.1) * x + np.float32(norm and key.endswith("weight"))
    if "token" in key or "pos_embed" in key:
        return np.float32(0.5) * x
    gain = next((g for name, g in _GAINS.items() if name in key), 1.0)
    return np.float32(gain / np.sqrt(np.prod(shape[1:]))) * x
