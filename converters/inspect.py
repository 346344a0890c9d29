"""Prints what a checkpoint or a weights file holds."""

import math

from . import guess, weights_file
from .checkpoint import read_checkpoint


def inspect(path):
    with open(path, "rb") as file:
        is_weights = file.read(len(weights_file.MAGIC)) == weights_file.MAGIC
    if is_weights:
        _weights(path)
    else:
        _checkpoint(read_checkpoint(path))


def _checkpoint(checkpoint):
    print(f"{checkpoint.path}: {checkpoint.format}")
    for line in guess.guess(checkpoint.tensors):
        _print(line)
    for note in checkpoint.notes:
        _print(note)
    for layer in checkpoint.layers:
        _print("layer " + layer)
    for layer, why in checkpoint.refused.items():
        _print(f"not converted: {layer}: {why}")
    _tensors(checkpoint.tensors)


def _weights(path):
    file = weights_file.read(path)
    h = file.header
    print(f"{path}: gestus weights, format {h['format_version']}, {h['file_size']:,} bytes "
          f"(metadata {h['metadata_size']:,}, data {h['data_size']:,}), "
          f"checksum {h['checksum']:016x}")
    for key, value in file.provenance.items():
        print(f"  {key}: {value}")
    for network in file.networks:
        print(f"network {network['name']}: {network['config_type']}")
        _fields(network["config"], "  ")
        for n in network.get("normalisations", []):
            print(f"  normalisation of {n['stream']}: {len(n['mean'])} mean(s), "
                  f"{len(n['deviation'])} deviation(s), divisor {n['divisor']:g}")
        if network.get("joints"):
            print("  joints: " + ", ".join(joint["name"] for joint in network["joints"]))
        print(f"  self-test: {'yes' if 'self_test' in network else 'no'}")
    _tensors(file.tensors)


def _fields(config, indent):
    for key, value in config.items():
        if isinstance(value, dict):
            print(f"{indent}{key}:")
            _fields(value, indent + "  ")
        else:
            print(f"{indent}{key}: {value:g}" if isinstance(value, float)
                  else f"{indent}{key}: {value}")


def _tensors(tensors):
    elements = 0
    for name, array in tensors.items():
        elements += math.prod(array.shape)
        _print(f"  {name}  {tuple(array.shape)}  {array.dtype}")
    print(f"{len(tensors)} tensors, {elements:,} parameters")


def _print(text):
    """Names are a file's content: nothing but printable characters reaches the terminal."""
    print("".join(c if c.isprintable() else "?" for c in text))
