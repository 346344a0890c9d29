"""Makes weights files: from checkpoints, or random."""

import hashlib

import numpy as np

from . import VERSION, kinds, networks, shapes, weights_file
from .errors import ConvertError
from .pos_embed import adapt_ast

SELF_TEST_TOLERANCE = 1e-4
SELF_TEST_SEED = 1

# Tensors that published checkpoints carry and inference has no use for.
_UNUSED = ("v.head.", "v.head_dist.", "num_batches_tracked", "discriminator.", "dis.")


def export(checkpoint, network, path, provenance, ast=None, allow_unused=False, self_test=True):
    """Writes the tensors of `checkpoint` (a Checkpoint) to the weights file `path`.

    Returns the report: lines about what was adapted, filled in from `ast` or left out.
    """
    report = []
    tensors = checkpoint_tensors(checkpoint, network, ast, report, allow_unused)
    source = f"{checkpoint.name} sha256:{_sha256(checkpoint.path)}"
    if ast is not None:
        source += f", {ast.name} sha256:{_sha256(ast.path)}"
    provenance = provenance | {"source": source}
    write(path, network, tensors, provenance, self_test, report)
    return report


def checkpoint_tensors(checkpoint, network, ast=None, report=None, allow_unused=True):
    """The tensors of `network` (key -> float32 array) from `checkpoint`, adapted to its shapes."""
    report = [] if report is None else report
    arrays = dict(checkpoint.tensors)
    if ast is not None:
        _fill_ast(arrays, ast, network, report)
    _adapt(arrays, network, report)
    return match(arrays, shapes.network_shapes(network), checkpoint.path, report, allow_unused)


def write(path, network, tensors, provenance, self_test, report):
    """Writes `tensors` (key -> array) of one network, with a self-test where PyTorch is there."""
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


def match(arrays, wanted, path, report, allow_unused=False):
    """The arrays that `wanted` (key -> shape) names, as float32; refuses any that are missing,
    misshapen or not known, naming the first few."""
    faults = []
    for key, shape in wanted.items():
        if key not in arrays:
            faults.append(f"{key}: missing, expected {shape}")
        elif arrays[key].shape != shape:
            faults.append(f"{key}: {arrays[key].shape}, expected {shape}")
        elif arrays[key].dtype.kind != "f":
            faults.append(f"{key}: {arrays[key].dtype}, expected floating point")
    for key in arrays:
        if key in wanted:
            continue
        if allow_unused or any(part in key for part in _UNUSED):
            report.append(f"unused: {key} {arrays[key].shape}")
        else:
            faults.append(f"{key}: {arrays[key].shape}, not part of this network "
                          "(--allow-unused leaves it out)")
    if faults:
        more = f"; and {len(faults) - 8} more" if len(faults) > 8 else ""
        raise ConvertError(f"{path}: " + "; ".join(faults[:8]) + more)
    return {key: _float32(key, arrays[key]) for key in wanted}


def _float32(key, array):
    with np.errstate(over="ignore"):
        x = np.ascontiguousarray(array, dtype="<f4")
    if not np.isfinite(x).all():
        raise ConvertError(f"tensor {key}: holds values that are not finite in float32")
    return x


def _ast_parts(network):
    """(prefix of keys, configuration) of every AST inside the network."""
    return kinds.of(network).ast_parts(network["config"])


def _fill_ast(arrays, ast, network, report):
    """Gives every AST of the network that the checkpoint lacks the tensors of `ast`."""
    for prefix, config in _ast_parts(network):
        if any(key.startswith(prefix) for key in arrays):
            report.append(f"{prefix}*: from the checkpoint, {ast.name} is not used for it")
            continue
        report.append(f"{prefix}*: from {ast.name}")
        for key, array in ast.tensors.items():
            # A head of the audio classes of that checkpoint says nothing here.
            if not key.startswith("mlp_head.") or config["head"] != "None":
                arrays[prefix + key] = array


def _adapt(arrays, network, report):
    for prefix, config in _ast_parts(network):
        adapt_ast(arrays, prefix, config, report)
        if config["head"] == "None":
            for key in [k for k in arrays if k.startswith(prefix + "mlp_head.")]:
                report.append(f"unused: {key} {arrays.pop(key).shape}, the configuration has no "
                              "head")


def _sha256(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
