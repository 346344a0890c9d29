"""Writes a case in every engine's form, with inputs and the outputs that all must agree with.

usage: python3 -m bench.peers.export FOLDER CASE...   -> FOLDER/<case>/
  gestus.fp32.fb  ort.fp32.onnx  torch.fp32.pt    the same weights
  <input>.bin  expected.bin                       raw values; expected is PyTorch's in double
  case.json                                       inputs, floating-point operations

narrow.py makes other types of these.
"""

import json
import pathlib
import sys
import warnings

import numpy as np
import torch
from torch.utils._python_dispatch import TorchDispatchMode

from converters import networks, weights_file
from converters.random_weights import random_weights

from . import modules
from .cases import CASES

OPSET = 17  # the newest that PyTorch 1.13 writes
SEED = 1


class FlopCounter(TorchDispatchMode):
    """Counts what matrix products and convolutions do, two operations for a multiply-add."""

    def __init__(self):
        super().__init__()
        self.flops = 0

    def __torch_dispatch__(self, function, types, arguments=(), keywords=None):
        result = function(*arguments, **(keywords or {}))
        name = function.overloadpacket.__name__
        if name in ("mm", "bmm", "addmm", "baddbmm"):
            left = arguments[1 if "add" in name else 0]
            self.flops += 2 * result.numel() * left.shape[-1]
        elif name == "convolution":
            self.flops += 2 * result.numel() * arguments[1][0].numel()
        return result


def export(folder, case):
    network = networks.complete(case.kind, {"config": case.config})
    part = getattr(modules, case.part)
    arrays = random_weights(network, SEED, part.needs)
    module = part(network, arrays)
    inputs = module.inputs(np.random.default_rng(SEED), case.size)
    tensors = tuple(torch.from_numpy(x) for x in inputs.values())
    with torch.no_grad(), FlopCounter() as counter:
        expected = module(*(x.double() if x.is_floating_point() else x for x in tensors))
    module = module.float()

    folder.mkdir(parents=True, exist_ok=True)
    weights_file.write(folder / "gestus.fp32.fb", [network], arrays,
                       {"trained": False, "recipe": f"random, seed {SEED}"})
    save_traced(module, tensors, folder / "torch.fp32.pt")
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")  # of shapes that become constants, as they should
        torch.onnx.export(module, tensors, str(folder / "ort.fp32.onnx"), opset_version=OPSET,
                          input_names=list(inputs))
    for name, x in inputs.items():
        x.tofile(folder / f"{name}.bin")
    expected = expected if isinstance(expected, tuple) else (expected,)
    np.concatenate([x.numpy().astype(np.float32).ravel() for x in expected]).tofile(
        folder / "expected.bin")
    _describe(folder, inputs, counter.flops)


def _describe(folder, inputs, flops):
    """Written last: a case without it is not whole."""
    (folder / "case.json").write_text(json.dumps({
        "flops": flops,
        "inputs": {name: {"shape": x.shape, "type": str(x.dtype)} for name, x in inputs.items()}}))


def save_traced(module, tensors, path):
    """Traced with the sizes as constants, so that nothing is computed from them when it runs."""
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")  # of shapes that become constants, as they should
        module(*tensors)  # what fix_constants remembers is no part of the trace
        traced = torch.jit.trace(module, tensors, check_trace=False)  # outputs are compared
    graph = traced.graph
    torch._C._jit_pass_inline(graph)
    torch._C._jit_pass_peephole(graph, False)
    torch._C._jit_pass_constant_propagation(graph)
    torch._C._jit_pass_dce(graph)
    torch.jit.save(traced, str(path))


def export_nothing(folder):
    """A model without work: what is left is the price of a call."""
    folder.mkdir(parents=True, exist_ok=True)
    x = torch.zeros(1)
    torch.onnx.export(torch.nn.Identity(), x, str(folder / "ort.fp32.onnx"), input_names=["x"])
    x.numpy().tofile(folder / "x.bin")
    _describe(folder, {"x": x.numpy()}, 0)


def main(folder, *names):
    modules.fix_constants()
    export_nothing(pathlib.Path(folder) / "nothing")
    for case in CASES:
        if case.name in names:
            print(f"exporting {case.name}", file=sys.stderr, flush=True)
            export(pathlib.Path(folder) / case.name, case)


if __name__ == "__main__":
    main(*sys.argv[1:])
