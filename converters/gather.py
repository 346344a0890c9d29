"""Finds the tensors of a network in checkpoints, whatever their names, and proves that they fit."""

import re

import numpy as np

from . import kinds, mapping, names, shapes
from .errors import ConvertError
from .pos_embed import adapt_ast
from .report import Report

# Tensors that checkpoints carry and inference has no use for.
_UNUSED = re.compile(
    r"v\.head\.|v\.head_dist\.|num_batches_tracked|discriminator\.|dis\.|"
    r"(^|\.)position_ids$")
# Heads of published language models, which the network of gestus does not have.
_UNUSED_OF_BERT = re.compile(
    r"(^|[._])cls\.(predictions|seq_relationship)\.|(^|\.)pooler\.|(^|\.)token_type_ids$|"
    r"(^|\.)(vocab_transform|vocab_layer_norm|vocab_projector|qa_outputs)\.")
_HEAD_OF_BERT = re.compile(r"(^|\.)(pre_classifier|classifier)\.")
_NORM = re.compile(r"norm\d?\.(weight|bias)$|mlp_head\.0\.")
_AST_HEAD_EPSILON = 1e-5  # of the published code, and fixed in ours
_SHOWN = 8


class Found:
    """Arrays by our keys, or by theirs where a key is none of ours, and where each comes from."""

    def __init__(self):
        self.arrays, self.origins, self.epsilons = {}, {}, {}
        self.offered = {}  # their key -> (shape, what ours would be), used or not

    def add(self, key, source, checkpoint, scheme=None, where=""):
        self.arrays[key] = _assemble(key, source, checkpoint)
        self.origins[key] = tuple(where + theirs for theirs in source.keys)
        for theirs in source.keys:
            if theirs not in checkpoint.implied:
                self.offered[where + theirs] = (checkpoint.tensors[theirs].shape, key)
        layer = source.keys[0].rpartition(".")[0]
        epsilon = checkpoint.epsilons.get(layer)
        if epsilon is None and scheme is not None and _NORM.search(key):
            epsilon = scheme.epsilon
        if epsilon is not None:
            self.epsilons[key] = (layer, epsilon)


def gather(checkpoint, network, ast=None, given=None, allow_unused=True, keep_epsilon=False,
           report=None):
    """The tensors of `network` (key -> float32 array) from `checkpoint`, adapted to its shapes.

    `ast` is a checkpoint for the ASTs that `checkpoint` lacks, `given` the Map of --map.
    Everything goes into `report`, before anything is refused.
    """
    report = Report(checkpoint, network) if report is None else report
    wanted = shapes.network_shapes(network)
    found = _named(checkpoint, network, wanted, given, report)
    if ast is not None:
        _fill_ast(found, ast, network, report)
    for prefix, config in _ast_parts(network):
        adapt_ast(found.arrays, prefix, config, report)
    faults = _match(found, wanted, checkpoint, network, allow_unused, report)
    if not keep_epsilon:
        faults += _epsilon_faults(found, wanted, network)
    if faults:
        more = f"; and {len(faults) - _SHOWN} more" if len(faults) > _SHOWN else ""
        raise ConvertError(f"{checkpoint.path}: " + "; ".join(faults[:_SHOWN]) + more)
    return {key: _float32(key, found.arrays[key]) for key in wanted}


# ------------------------------------------------------------------------------------------- names


def _named(checkpoint, network, wanted, given, report):
    """Found under our names: those of the map, of published checkpoints, or as they are."""
    sources, schemes = {}, {}
    for prefix, keys, known in _scopes(checkpoint, network):
        named = names.canonical([key[len(prefix):] for key in keys], known)
        _note(named, prefix, report)
        for ours, source in named.sources.items():
            sources[prefix + ours] = source._replace(keys=tuple(prefix + x for x in source.keys))
            schemes[prefix + ours] = named.scheme
    if given is not None:
        mapped = mapping.expand(given, wanted, checkpoint)
        taken = {key for source in mapped.values() for key in source.keys}
        schemes = {ours: scheme for ours, scheme in schemes.items() if ours not in mapped}
        sources = {ours: source for ours, source in sources.items()
                   if ours in wanted or not taken.issuperset(source.keys)} | mapped
    found = Found()
    for key, array in checkpoint.tensors.items():
        if key not in checkpoint.implied:
            found.offered[key] = (array.shape, key)
    for ours, source in sources.items():
        found.add(ours, source, checkpoint, schemes.get(ours))
    return found


def _scopes(checkpoint, network):
    """(prefix, keys, schemes that they may follow) of every AST inside, and of the other keys."""
    rest = list(checkpoint.tensors)
    for prefix, _ in _ast_parts(network):
        yield prefix, [key for key in rest if key.startswith(prefix)], [names.AST]
        rest = [key for key in rest if not key.startswith(prefix)]
    schemes = [names.DISTILBERT, names.BERT] if kinds.kind_of(network) == "bert" else []
    yield "", rest, schemes


def _note(named, prefix, report):
    if named.scheme is not None:
        report.append((f"{prefix}*: " if prefix else "") + f"names of {named.scheme.title}")


def _assemble(key, source, checkpoint):
    arrays = [checkpoint.tensors[theirs] for theirs in source.keys]
    if source.transpose:
        arrays = [x.T for x in arrays]
    if source.join is None:
        return arrays[0]
    try:
        return np.concatenate(arrays, source.join)
    except ValueError:  # AxisError is one
        raise ConvertError(f"{checkpoint.path}: {key}: {', '.join(source.keys)} of shapes "
                           f"{', '.join(str(x.shape) for x in arrays)} cannot be joined along "
                           f"axis {source.join}") from None


# ------------------------------------------------------------------------------------------- ASTs


def _ast_parts(network):
    """(prefix of keys, configuration) of every AST inside the network."""
    return kinds.of(network).ast_parts(network["config"])


def _fill_ast(found, ast, network, report):
    """Gives every AST of the network that the checkpoint lacks the tensors of `ast`."""
    named = names.canonical(ast.tensors, [names.AST])
    _note(named, f"{ast.name}: ", report)
    for prefix, _ in _ast_parts(network):
        if any(key.startswith(prefix) for key in found.arrays):
            report.append(f"{prefix}*: from the checkpoint, {ast.name} is not used for it")
            continue
        report.append(f"{prefix}*: from {ast.name}")
        for key, source in named.sources.items():
            found.add(prefix + key, source, ast, named.scheme, f"{ast.name}: ")


# --------------------------------------------------------------------------------------- the proof


def _match(found, wanted, checkpoint, network, allow_unused, report):
    """Fills the report; returns sentences about what cannot be."""
    faults = []
    for key, shape in wanted.items():
        array = found.arrays.get(key)
        if array is None:
            why = checkpoint.why_refused(key)
            report.missing[key] = (shape, why)
            faults.append(f"{key}: missing, expected {shape}" + (f", {why}" if why else ""))
        elif array.shape != shape or array.dtype.kind != "f":
            got, want = ((array.shape, shape) if array.shape != shape
                         else (array.dtype, "floating point"))
            report.misshapen[key] = (got, want)
            faults.append(f"{key}: {got}, expected {want}{_from(found, key)}")
        else:
            report.used[key] = found.origins[key]
    used = {theirs for key in wanted for theirs in found.origins.get(key, ())}
    for theirs, (shape, ours) in found.offered.items():
        if theirs in used:
            continue
        report.unused[theirs] = (shape, None)
        if not (allow_unused or _known_unused(ours, network)):
            faults.append(f"{theirs}: {shape}, not part of this network "
                          "(--allow-unused leaves it out)")
    explained = {key.rpartition(".")[0] for key in report.missing}
    for layer, why in checkpoint.refused.items():
        report.unused[layer] = (None, why)
        if not allow_unused and layer not in explained:
            faults.append(f"{layer}: {why} (--allow-unused leaves it out)")
    return faults


def _from(found, key):
    origin = found.origins[key]
    return "" if origin == (key,) else f" (from {', '.join(origin)})"


def _known_unused(key, network):
    if _UNUSED.search(key):
        return True
    if kinds.kind_of(network) == "bert":
        return bool(_UNUSED_OF_BERT.search(key) or (
            network["config"]["head"] == "None" and _HEAD_OF_BERT.search(key)))
    return any(key.startswith(prefix + "mlp_head.") and config["head"] == "None"
               for prefix, config in _ast_parts(network))


def _epsilon_faults(found, wanted, network):
    """LayerNorms of the checkpoint that had another epsilon than the configuration gives them."""
    faults, layers = [], set()
    for key, (layer, epsilon) in found.epsilons.items():
        if key not in wanted or layer in layers:
            continue
        where, config = _epsilon(network, key)
        if config is not None and np.float32(epsilon) != np.float32(config):
            layers.add(layer)
            faults.append(f"layer {layer}: LayerNorm epsilon {epsilon:g}, expected {config:g} as "
                          f"{where} (--keep-epsilon takes that)")
    return faults


def _epsilon(network, key):
    """(what it is called, value or None) of the epsilon that the engine will use for `key`."""
    config = network["config"]
    for prefix, ast in _ast_parts(network):
        if key.startswith(prefix + "mlp_head."):
            return "the engine has in AST's head", _AST_HEAD_EPSILON
        if key.startswith(prefix + "v."):
            return f"config.{prefix}ln_eps", ast["ln_eps"]
    where = "config.core." if "core" in config else "config."
    config = config.get("core", config)
    name = "ln_eps" if "ln_eps" in config else "decoder_ln_eps"
    return where + name, config.get(name)


def _float32(key, array):
    with np.errstate(over="ignore"):
        x = np.ascontiguousarray(array, dtype="<f4")
    if not np.isfinite(x).all():
        raise ConvertError(f"tensor {key}: holds values that are not finite in float32")
    return x
