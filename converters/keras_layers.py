"""Lays the variables of Keras' layers out as PyTorch's parameters.

Which layer a variable belongs to is in its name ("bidirectional/forward_lstm/lstm_cell/kernel:0");
what the layer computes is in model_config, where the file has one.  A layer that PyTorch's modules
do not compute gives no tensors but a reason, which is told when a network asks for them.
"""

import re
from typing import NamedTuple

import numpy as np

from .errors import ConvertError

MAX_DEPTH = 16
MAX_LAYERS = 1 << 16
MAX_KEY = 255
DEFAULT_EPSILON = 1e-3  # Keras' own

_CELL = re.compile(r"(lstm|gru|simple_rnn)_cell(_\d+)?")
_WRAPPERS = ("Bidirectional", "TimeDistributed")
_SUPPORTED = ("LSTM", "Dense", "Conv1D", "Embedding", "LayerNormalization", "MultiHeadAttention")
_HEADS = ("query", "key", "value")
# What PyTorch's modules have: field -> (value, Keras' default).
_LSTM_FIELDS = {"activation": ("tanh", "tanh"), "recurrent_activation": ("sigmoid", "sigmoid")}
_CONV_FIELDS = {"strides": (1, 1), "dilation_rate": (1, 1), "groups": (1, 1),
                "data_format": ("channels_last", "channels_last")}
_SHOWN = ("units", "filters", "kernel_size", "padding", "activation", "recurrent_activation",
          "return_sequences", "go_backwards", "use_bias", "epsilon", "alpha", "rate", "input_dim",
          "output_dim", "num_heads", "key_dim", "mask_zero", "n")


class Converted:
    """See the fields of converters.checkpoint.Checkpoint."""

    def __init__(self):
        self.tensors, self.layers, self.epsilons = {}, [], {}
        self.refused, self.implied, self.notes = {}, set(), []


class Layer(NamedTuple):
    name: str        # after the names of the models around it, with dots
    kind: str        # its class
    config: dict
    wrappers: tuple  # (class, configuration) around it, outermost first

    def __str__(self):
        shown = [f"{field} {str(self.config[field])[:60]}" for field in _SHOWN
                 if field in self.config]
        if self.kind == "LSTM":
            shown.append("gate order i f c o")
        if self.kind == "Lambda":
            shown = ["its code is not read"]
        shown += [f"merge_mode {config.get('merge_mode', 'concat')}"
                  for wrapper, config in self.wrappers if wrapper == "Bidirectional"]
        kinds = " of ".join([*(wrapper for wrapper, _ in self.wrappers), self.kind])
        return f"{self.name}: {kinds}" + "".join(", " + text for text in shown)

    def bidirectional(self):
        return next((config for kind, config in self.wrappers if kind == "Bidirectional"), None)


class _Unsupported(Exception):
    """Why a layer is none of PyTorch's modules."""


def convert(path, config, variables):
    """Converted, of model_config (or None) and the variables: (group of a layer, name, array)."""
    found, layers = Converted(), {}
    if config is None:
        found.notes.append("no model_config in the file: activations, directions and epsilons of "
                           "its layers are not checked")
    else:
        _walk(path, config, None, "", layers, 0)
        found.layers = list(dict.fromkeys(map(str, layers.values())))
    for parts, arrays in _by_layer(path, variables).items():
        names, suffix = parts, ""
        if "recurrent_kernel" in arrays and parts[-1].startswith(("forward_", "backward_")):
            names, suffix = parts[:-1], "_reverse" if parts[-1].startswith("backward_") else ""
        try:
            kind = _convert(path, names, suffix, arrays, layers, found)
        except _Unsupported as reason:
            found.refused[".".join(names)] = str(reason)
            kind = f"not supported, {reason}"
        if config is None:
            found.layers.append(f"{'.'.join(parts)}: {kind}")
    return found


# ----------------------------------------------------------------------------------- model_config


def _walk(path, model, group, prefix, layers, depth):
    """Adds the layers of a model to `layers`: (group at the top of the file, name) -> Layer."""
    config = model.get("config") if isinstance(model, dict) else None
    # Old Sequential models are bare lists.
    entries = config.get("layers") if isinstance(config, dict) else config
    if not isinstance(entries, list) or depth > MAX_DEPTH:
        raise ConvertError(f"{path}: model_config is no model of layers, or nested too deeply")
    for entry in entries:
        kind, config, wrappers = _entry(path, entry)
        names = [config.get("name")]
        while kind in _WRAPPERS and len(wrappers) < MAX_DEPTH:
            wrappers.append((kind, config))
            kind, config, _ = _entry(path, config.get("layer"))
            names.append(config.get("name"))
        names = [name for name in names if isinstance(name, str)]
        if not names or len(layers) > MAX_LAYERS:
            raise ConvertError(f"{path}: model_config has a layer without a name, or more than "
                               f"{MAX_LAYERS} layers")
        top = group or names[0]
        if isinstance(config.get("layers"), list):
            _walk(path, {"config": config}, top, f"{prefix}{names[0]}.", layers, depth + 1)
            continue
        layer = Layer(prefix + names[0], kind, config, tuple(wrappers))
        layers[top, names[0]] = layer
        for name in names[1:]:
            layers.setdefault((top, name), layer)


def _entry(path, entry):
    if isinstance(entry, dict) and isinstance(entry.get("class_name"), str):
        config = entry.get("config")
        if isinstance(config, list):  # an old Sequential inside
            config = {"name": entry.get("name"), "layers": config}
        if isinstance(config, dict):
            return entry["class_name"], config, []
    raise ConvertError(f"{path}: model_config has a layer without class_name or config")


# -------------------------------------------------------------------------------------- variables


def _by_layer(path, variables):
    """(name, name, ...) of a layer, from the top of the file down -> {variable: array}."""
    found = {}
    for group, name, array in variables:
        *parts, variable = name.split("/")
        # Names begin with those of models around it, or leave out the layer's own.
        parts = parts[parts.index(group):] if group in parts else [group, *parts]
        if parts[1:] and _CELL.fullmatch(parts[-1]):
            parts.pop()
        variable = variable.removesuffix(":0")
        key = ".".join([*parts, variable])
        if not key.isprintable() or len(key) > MAX_KEY:
            raise ConvertError(f"{path}: {key[:80]!r}: expected at most {MAX_KEY} printable "
                               "characters")
        if variable in found.setdefault(tuple(parts), {}):
            raise ConvertError(f"{path}: {key} is there twice")
        found[tuple(parts)][variable] = array
    return found


def _convert(path, names, suffix, arrays, layers, found):
    """Adds the tensors of one layer to `found`; returns what kind it is taken for."""
    layer = layers.get((names[0], names[-1]))
    parent = layers.get((names[0], names[-2])) if len(names) > 1 else None
    if "recurrent_kernel" in arrays:
        _check_lstm(layer)
        kind, given, implied = "LSTM", *_lstm(arrays, suffix)
    elif _is_attention(names[-1], arrays, parent, bool(layers)):
        kind, given, implied = "MultiHeadAttention", *_attention(names[-1], arrays)
    else:
        kind, given, implied = _simple(layer, arrays)
        if layer is not None and layer.kind != kind:
            raise _Unsupported(f"class {layer.kind} with the variables {', '.join(arrays)}")
    key = ".".join(names)
    for name, array in (given | implied).items():
        if f"{key}.{name}" in found.tensors:
            raise ConvertError(f"{path}: {key}.{name} is there twice")
        found.tensors[f"{key}.{name}"] = array
    found.implied |= {f"{key}.{name}" for name in implied}
    if kind == "LayerNormalization" and layer is not None:
        epsilon = layer.config.get("epsilon", DEFAULT_EPSILON)
        if not isinstance(epsilon, (int, float)):
            raise ConvertError(f"{path}: layer {key}: epsilon {str(epsilon)[:60]}, expected a "
                               "number")
        found.epsilons[key] = epsilon
    return kind


# --------------------------------------------------------------------------------- kinds of layers


def _check_lstm(layer):
    if layer is None:
        return
    if layer.kind != "LSTM":
        raise _Unsupported(f"class {layer.kind}, expected {', '.join(_SUPPORTED)}")
    both = layer.bidirectional()
    if both is None:
        _check_fields(layer.config, {**_LSTM_FIELDS, "go_backwards": (False, False)}, "LSTM")
        return
    _check_fields(both, {"merge_mode": ("concat", "concat")}, "Bidirectional")
    _check_fields(layer.config, {**_LSTM_FIELDS, "go_backwards": (False, False)}, "forward LSTM")
    backward = both.get("backward_layer")
    if backward is not None:
        config = backward.get("config") if isinstance(backward, dict) else None
        if not isinstance(config, dict) or backward.get("class_name") != "LSTM":
            raise _Unsupported("a backward layer that is no LSTM")
        _check_fields(config, {**_LSTM_FIELDS, "go_backwards": (True, False)}, "backward LSTM")


def _check_fields(config, fields, what):
    for name, (wanted, default) in fields.items():
        value = config.get(name, default)
        value = value[0] if isinstance(value, list) and len(value) == 1 else value
        if value != wanted:
            raise _Unsupported(f"{what} with {name} {str(value)[:60]}, expected {wanted}")


# Each gives the tensors of its layer, and those that the layer does without: zeros and ones.


def _lstm(arrays, suffix):
    """Gates i, f, c, o are PyTorch's i, f, g, o; PyTorch has two biases, which it adds."""
    _expect_only(arrays, "kernel", "recurrent_kernel", "bias")
    kernel, recurrent = arrays.get("kernel"), arrays["recurrent_kernel"]
    if kernel is None or kernel.ndim != 2 or recurrent.ndim != 2 or (
            kernel.shape[1] != recurrent.shape[1] or recurrent.shape[1] != 4 * recurrent.shape[0]):
        raise _Unsupported(f"recurrent_kernel of shape {recurrent.shape}, expected an LSTM's four "
                           "gates (units, 4 units)")
    given = {"weight_ih_l0": kernel.T, "weight_hh_l0": recurrent.T}
    zeros = np.zeros(kernel.shape[1], np.float32)
    implied = {"bias_hh_l0": zeros}
    if "bias" in arrays:
        given["bias_ih_l0"] = arrays["bias"]
    else:
        implied["bias_ih_l0"] = zeros
    return tuple({name + suffix: x for name, x in part.items()} for part in (given, implied))


def _is_attention(name, arrays, parent, known):
    """Whether these are the query, key, value or output of a MultiHeadAttention."""
    kernel = arrays.get("kernel")
    if kernel is None or kernel.ndim != 3 or name not in (*_HEADS, "attention_output"):
        return False
    return parent.kind == "MultiHeadAttention" if parent is not None else not known


def _attention(name, arrays):
    """(columns, heads, width) in, (heads, width, rows) out -> (rows, columns)."""
    _expect_only(arrays, "kernel", "bias")
    kernel = arrays["kernel"]
    columns = kernel.shape[0] if name in _HEADS else kernel.shape[0] * kernel.shape[1]
    return _with_bias(kernel.reshape(columns, -1).T, arrays)


def _simple(layer, arrays):
    """(kind, given, implied) of a layer whose variables say what it is."""
    if layer is not None and layer.kind not in _SUPPORTED:
        raise _Unsupported(f"class {layer.kind}, expected {', '.join(_SUPPORTED)}")
    kernel = arrays.get("kernel")
    if "moving_mean" in arrays:
        raise _Unsupported("class BatchNormalization by its variables, expected "
                           + ", ".join(_SUPPORTED))
    if kernel is not None and kernel.ndim == 2:
        _expect_only(arrays, "kernel", "bias")
        return "Dense", *_with_bias(kernel.T, arrays)
    if kernel is not None and kernel.ndim == 3:
        _expect_only(arrays, "kernel", "bias")
        if layer is not None:
            _check_fields(layer.config, _CONV_FIELDS, "Conv1D")
            if kernel.shape[0] > 1:
                _check_fields(layer.config, {"padding": ("same", "valid")}, "Conv1D")
        return "Conv1D", *_with_bias(kernel.transpose(2, 1, 0), arrays)
    if set(arrays) in ({"gamma", "beta"}, {"gamma"}, {"beta"}):
        size = next(iter(arrays.values())).shape
        given = {ours: arrays[theirs] for ours, theirs in (("weight", "gamma"), ("bias", "beta"))
                 if theirs in arrays}
        implied = {"weight": np.ones(size, np.float32), "bias": np.zeros(size, np.float32)}
        return "LayerNormalization", given, {name: x for name, x in implied.items()
                                             if name not in given}
    if set(arrays) == {"embeddings"}:
        return "Embedding", {"weight": arrays["embeddings"]}, {}
    # Of a layer of the author's own: offered as they are, under their own names.
    return "class of its own", arrays, {}


def _with_bias(weight, arrays):
    if "bias" in arrays:
        return {"weight": weight, "bias": arrays["bias"].reshape(-1)}, {}
    return {"weight": weight}, {"bias": np.zeros(weight.shape[0], np.float32)}


def _expect_only(arrays, *names):
    for name, x in arrays.items():
        if name not in names:
            raise _Unsupported(f"variable {name} of shape {x.shape}, expected {', '.join(names)}")
