"""Builds the reference of a network from arrays and runs it, in double precision."""

import numpy as np
import torch

from ..shapes import kind_of
from .ast import AstNetwork
from .blocks import no_tap
from .zs_mstm1 import ZsMstm1

_MODULES = {"ast": AstNetwork, "zs_mstm1": ZsMstm1}


def build(network, arrays):
    """The module of a completed network with the weights `arrays` (key -> NumPy array)."""
    # Parameters are overwritten below: what they are initialised with only costs time.
    with torch.no_grad(), _without_initialisation():
        module = _MODULES[kind_of(network)](network).double().eval()
        module.weights().load_state_dict(
            {key: torch.from_numpy(np.array(array)) for key, array in arrays.items()})
    return module


def run(module, inputs, taps=False):
    """Outputs of the module (name -> float32 array) and, under "tap/<name>", its intermediates."""
    found = {}

    def tap(name, value):
        found["tap/" + name] = value.numpy().astype(np.float32)

    with torch.no_grad():
        tensors = {name: torch.from_numpy(np.asarray(x, np.float64)) for name, x in inputs.items()}
        outputs = module(tensors, tap if taps else no_tap)
    return {name: x.numpy().astype(np.float32) for name, x in outputs.items()} | found


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
