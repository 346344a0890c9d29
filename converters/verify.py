"""Compares the engine with PyTorch, layer by layer, on one seeded input."""

import os
import subprocess
import tempfile

import numpy as np

from . import mapping, networks, shapes, weights_file
from .checkpoint import read_checkpoint
from .errors import ConvertError
from .export import checkpoint_tensors
from .quantised import Quantised


def verify(options):
    """Prints a table of relative errors; 1 when a value is further off than the tolerance."""
    from .reference.run import build, run
    file = weights_file.read(options.weights)
    if len(file.networks) != 1:
        raise ConvertError(f"{options.weights}: {len(file.networks)} networks, expected one")
    network = file.networks[0]
    tensors = shapes.network_tensors(network, file.network_tensors(network))
    if options.checkpoint:
        # What only accompanies the weights, such as a vocabulary, stays the file's.
        tensors |= checkpoint_tensors(read_checkpoint(options.checkpoint), network,
                                      options.ast and read_checkpoint(options.ast),
                                      options.map and mapping.read(options.map))
    inputs = networks.random_inputs(network, options.seed)
    want = run(build(network, tensors), inputs, taps=True)
    tolerance = _tolerance(file) if options.tolerance is None else options.tolerance
    good = True
    for isa in options.isas.split(",") if options.isas else [None]:
        if isa:
            print(f"on {isa}")
        got = run_engine(options.infer_cli, options.weights, inputs, isa)
        good &= _report(got, want, tolerance, options.infer_cli)
    return 0 if good else 1


def _report(got, want, tolerance, infer_cli):
    """Prints the errors; whether all are small enough."""
    rows = compare(got, want)
    width = max(len(name) for name, *_ in rows)
    print(f"{'value':{width}}  {'shape':>14}  relative error")
    for name, shape, error in rows:
        print(f"{name:{width}}  {shape!s:>14}  {error:.2e}")
    failed = [row for row in rows if not row[2] <= tolerance]
    for name, _, error in failed:
        if name in got:
            print(f"{name}: relative error {error:.2e}, expected at most {tolerance:g}")
        else:
            print(f"{name}: not among what {infer_cli} gave, expected {want[name].shape}")
    return not failed


def _tolerance(file):
    """By the narrowest type of a weight: rows are rounded or quantised too, PyTorch's
    are not.  Half as much again as quantise allows, for other inputs."""
    types = {tensor.dtype for tensor in file.tensors.values() if isinstance(tensor, Quantised)}
    return 0.045 if "I8" in types else 0.015 if "BF16" in types else 1e-4


def run_engine(infer_cli, weights, inputs, isa=None):
    """Arrays that infer-cli makes of `inputs`, intermediates included; `isa` as GESTUS_ISA."""
    environment = {**os.environ, "GESTUS_ISA": isa} if isa else None
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, "input.npz"), os.path.join(folder, "output.npz")
        np.savez(source, **inputs)
        command = [infer_cli, weights, source, "-o", target, "--taps"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False,
                                  env=environment)
        except OSError as error:
            raise ConvertError(f"{infer_cli}: {error.strerror}") from None
        if done.returncode != 0:
            raise ConvertError(f"{infer_cli}: exit code {done.returncode}: "
                               + done.stderr.strip()[:200])
        with np.load(target, allow_pickle=False) as arrays:
            return {name: arrays[name] for name in arrays.files}


def compare(got, want):
    """(name, shape, max |got - want| / max |want|) of every value that is wanted, taps first, in the
    order of execution; infinity for one that was not got."""
    order = [*[n for n in want if n.startswith("tap/")],
             *[n for n in want if not n.startswith("tap/")]]
    return [(name, got[name].shape, relative_error(got[name], want[name])) if name in got
            else (name, want[name].shape, float("inf")) for name in order]


def relative_error(got, want):
    """Infinity where the sizes, or whole numbers, differ."""
    if got.size != want.size or got.dtype.kind != want.dtype.kind:
        return float("inf")
    if want.dtype.kind == "i":
        return 0.0 if np.array_equal(got.reshape(want.shape), want) else float("inf")
    difference = np.abs(got.reshape(want.shape).astype(np.float64) - want)
    largest = np.abs(want).max()
    return float(difference.max() / largest) if largest > 0 else float(difference.max())
