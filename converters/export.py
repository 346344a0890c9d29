"""Makes weights files: from checkpoints, or random."""

import hashlib

import numpy as np

from . import VERSION, networks, weights_file
from .gather import gather

SELF_TEST_TOLERANCE = 1e-4
SELF_TEST_SEED = 1


def export(checkpoint, network, path, provenance, report, extra=None, self_test=True, **options):
    """Writes the tensors of `checkpoint` (a Checkpoint) and the `extra` ones (key -> array) to the
    weights file `path`; `report` (a Report) says what was adapted, filled in or left out.

    The `options` are those of `gather`.
    """
    tensors = gather(checkpoint, network, report=report, **options) | (extra or {})
    sources = [checkpoint] + [x for x in (options.get("ast"),) if x is not None]
    provenance = provenance | {"source": ", ".join(f"{x.name} sha256:{_sha256(x.path)}"
                                                   for x in sources)}
    write(path, network, tensors, provenance, self_test, report)


def checkpoint_tensors(checkpoint, network, ast=None, given=None):
    """The tensors of `network` (key -> float32 array) as they are exported, for a comparison."""
    return gather(checkpoint, network, ast, given, keep_epsilon=True)


def write(path, network, tensors, provenance, self_test, report):
    """Writes `tensors` (key -> array) of one network, with a self-test where PyTorch is there; what
    there is to say is appended to `report`."""
    network = dict(network)
    test = _self_test(network, tensors, report) if self_test else {}
    named = {network["prefix"] + key: array for key, array in tensors.items()}
    provenance = {key: value for key, value in provenance.items() if value is not None}
    provenance["converter"] = f"gestus converters {VERSION}"
    weights_file.write(path, [network], named | test, provenance)


def _self_test(network, tensors, report):
    try:
        from .reference.run import build
    except ModuleNotFoundError as missing:
        report.append(f"no self-test: {missing.name} is not installed")
        return {}
    return make_self_test(network, build(network, tensors), SELF_TEST_SEED)


def make_self_test(network, module, seed):
    """Tensors of a self-test, which is added to `network`: seeded inputs and PyTorch's output."""
    from .reference.run import run
    inputs = networks.random_inputs(network, seed)
    output = run(module, inputs)[module.output]
    prefix = network["prefix"] + "self_test/"
    network["self_test"] = {
        "input_names": list(inputs), "inputs": [prefix + "input/" + name for name in inputs],
        "output_name": module.output, "output": prefix + "output/" + module.output,
        "relative_tolerance": SELF_TEST_TOLERANCE,
    }
    return ({prefix + "input/" + name: x for name, x in inputs.items()}
            | {prefix + "output/" + module.output: np.ascontiguousarray(output)})


def _sha256(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
