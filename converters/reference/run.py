"""Builds the reference of a network from arrays and runs it, in double precision."""

import importlib

import numpy as np
import torch

from .. import kinds
from .blocks import no_tap


def new(network, **optional):
    """The module of a completed network as PyTorch initialises it."""
    module = importlib.import_module(f"{__package__}.{kinds.kind_of(network)}").Network
    return module(network, **optional)


def build(network, arrays):
    """The module of a completed network with the weights `arrays` (key -> NumPy array)."""
    optional = {key: arrays[key] for key in kinds.of(network).optional if key in arrays}
    # Parameters are overwritten below: what they are initialised with only costs time.
    with torch.no_grad(), _without_initialisation():
        module = new(network, **optional).double().eval()
        module.weights().load_state_dict({key: torch.from_numpy(np.array(array))
                                          for key, array in arrays.items() if key not in optional})
    return module


def run(module, inputs, taps=False, **options):
    """Outputs of the module (name -> array) and, under "tap/<name>", its intermediates; `options`
    are those of a run, such as the seed of what is drawn."""
    found = {}

    def tap(name, value):
        found["tap/" + name] = _to_numpy(value)

    with torch.no_grad():
        tensors = {name: torch.from_numpy(np.asarray(x, _WIDE[np.asarray(x).dtype.kind]))
                   for name, x in inputs.items()}
        outputs = module(tensors, tap if taps else no_tap, **options)
    return {name: _to_numpy(x) for name, x in outputs.items()} | found


# Kind of number -> as the reference computes, and as files hold it.
_WIDE = {"f": np.float64, "i": np.int64}
_NARROW = {"f": np.float32, "i": np.int32}


def _to_numpy(tensor):
    array = tensor.numpy()
    return array.astype(_NARROW[array.dtype.kind])


class _without_initialisation:
    """Leaves parameters as they are allocated while modules are made."""

    _NAMES = ("uniform_", "normal_", "kaiming_uniform_", "xavier_uniform_", "constant_")

    def __enter__(self):
        self.saved = {name: getattr(torch.nn.init, name) for name in self._NAMES}
        for name in self._NAMES:
            setattr(torch.nn.init, name, lambda tensor, *args, **kwargs: tensor)

    def __exit__(self, *exception):
        for name, function in self.saved.items():
            setattr(torch.nn.init, name, function)
