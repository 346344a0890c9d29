"""Random weights whose outputs are of order one and follow every input.

Fan-in scaling keeps every layer's signal at order one at full size and in the tiny geometries of
the tests alike.  Each tensor has its own stream of numbers, from the seed and its name.
"""

import re
import zlib

import numpy as np

from . import kinds, shapes


def random_weights(network, seed, only=()):
    """key -> float32 array for a completed network; `only` those whose keys begin so, if given."""
    kind = kinds.of(network)
    return {key: _tensor(kind, key, shape, seed)
            for key, shape in shapes.network_shapes(network).items()
            if not only or key.startswith(tuple(only))}


def save_checkpoint(path, tensors):
    """A checkpoint as torch.save writes it: a state_dict of `tensors`."""
    import torch
    torch.save({key: torch.from_numpy(array) for key, array in tensors.items()}, path)


def _tensor(kind, key, shape, seed):
    rng = np.random.default_rng([seed, zlib.crc32(key.encode())])
    x = rng.standard_normal(shape, dtype=np.float32)
    if len(shape) == 1:
        norm = any(part in key for part in (".norm", "LayerNorm", "mlp_head.0"))
        return np.float32(0.1) * x + np.float32(norm and key.endswith("weight"))
    deviation = _first(kind.tables, key)
    if deviation is not None:
        return np.float32(deviation) * x
    gain = _first(kind.gains, key)
    return np.float32((1.0 if gain is None else gain) / np.sqrt(np.prod(shape[1:]))) * x


def _first(factors, key):
    """The value of the first expression in `factors` that is found in `key`."""
    return next((factor for name, factor in factors.items() if re.search(name, key)), None)
