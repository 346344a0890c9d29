"""Writes HDF5 files as Keras of TensorFlow 2 does, without TensorFlow: groups, attributes and names
after its documentation and its files.  Layers are (class, configuration, {variable: array})."""

import json

import h5py
import numpy as np


def lstm(name, kernel, recurrent, bias, **config):
    config = {"name": name, "units": recurrent.shape[0], "activation": "tanh",
              "recurrent_activation": "sigmoid", "use_bias": bias is not None,
              "unit_forget_bias": True, "return_sequences": True, "go_backwards": False, **config}
    variables = {"kernel": kernel, "recurrent_kernel": recurrent, "bias": bias}
    return "LSTM", config, {f"{name}/lstm_cell/{key}:0": x for key, x in variables.items()
                            if x is not None}


def bidirectional(name, forward, backward, **config):
    """Of two `lstm`s; the backward one's configuration is not written, as in Keras."""
    variables = {}
    for direction, (_, inner, arrays) in (("forward", forward), ("backward", backward)):
        cell = {"forward": "lstm_cell_1", "backward": "lstm_cell_2"}[direction]
        for key, x in arrays.items():
            variables[f"{name}/{direction}_{inner['name']}/{cell}/{key.split('/')[-1]}"] = x
    return "Bidirectional", {"name": name, "merge_mode": "concat",
                             "layer": {"class_name": "LSTM", "config": forward[1]},
                             **config}, variables


def dense(name, kernel, bias, **config):
    return _kernel("Dense", name, kernel, bias,
                   {"units": kernel.shape[-1], "activation": "linear", **config})


def conv1d(name, kernel, bias, **config):
    return _kernel("Conv1D", name, kernel, bias,
                   {"filters": kernel.shape[-1], "kernel_size": [kernel.shape[0]], "strides": [1],
                    "padding": "same", "data_format": "channels_last", "dilation_rate": [1],
                    "groups": 1, "activation": "relu", **config})


def _kernel(kind, name, kernel, bias, config):
    variables = {"kernel": kernel} if bias is None else {"kernel": kernel, "bias": bias}
    return kind, {"name": name, "use_bias": bias is not None, **config}, {
        f"{name}/{key}:0": x for key, x in variables.items()}


def layer(kind, name, variables=None, **config):
    return kind, {"name": name, **config}, {f"{name}/{key}:0": x
                                            for key, x in (variables or {}).items()}


def time_distributed(name, inner):
    kind, config, variables = inner
    return "TimeDistributed", {"name": name, "layer": {"class_name": kind, "config": config}}, {
        f"{name}/" + key.split("/")[-1]: x for key, x in variables.items()}


def nested(name, layers, kind="Functional"):
    """A model used as a layer: its variables keep the names they have in it."""
    return kind, {"name": name, "layers": [_described(x) for x in layers]}, {
        key: x for _, _, variables in layers for key, x in variables.items()}


def _described(one):
    kind, config, _ = one
    return {"class_name": kind, "config": config, "name": config["name"], "inbound_nodes": []}


def write_model(path, layers, kind="Functional", **options):
    """model.save(path)"""
    with h5py.File(path, "w") as file:
        config = {"class_name": kind,
                  "config": {"name": "model", "layers": [_described(x) for x in layers]}}
        file.attrs["keras_version"] = "2.11.0"
        file.attrs["backend"] = "tensorflow"
        file.attrs["model_config"] = json.dumps(config).encode("utf8")
        _write_group(file.create_group("model_weights"), layers, **options)
        file.create_group("optimizer_weights").create_dataset("Adam/iter:0", data=np.int64(3))


def write_weights(path, layers, **options):
    """model.save_weights(path)"""
    with h5py.File(path, "w") as file:
        _write_group(file, layers, **options)


def _write_group(file, layers, **options):
    write_names(file, "layer_names", [config["name"] for _, config, _ in layers])
    file.attrs["backend"] = "tensorflow"
    file.attrs["keras_version"] = "2.11.0"
    for _, config, variables in layers:
        group = file.create_group(config["name"])
        write_names(group, "weight_names", list(variables))
        for key, x in variables.items():
            group.create_dataset(key, data=x, **options)


def write_names(group, name, names, limit=64512):
    """One attribute, or several that HDF5's headers can hold."""
    array = np.asarray([x.encode() for x in names])
    if array.nbytes <= limit:
        group.attrs[name] = array
        return
    parts = np.array_split(array, -(-array.nbytes // limit))
    for n, part in enumerate(parts):
        group.attrs[f"{name}{n}"] = part
