"""Reads checkpoints: says by its content what a file is, and what tensors it holds."""

import dataclasses
import os

from . import safetensors, torch_zip, weights_file
from .errors import ConvertError

TORCH, SAFETENSORS, KERAS = "PyTorch zip", "safetensors", "Keras HDF5"

_ZIP = b"PK\x03\x04"
_HDF5 = b"\x89HDF\r\n\x1a\n"
_LEGACY_TORCH = b"\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19"

# Put in front of every key by torch.nn.DataParallel and torch.compile.
KEY_PREFIXES = ("module.", "_orig_mod.")


@dataclasses.dataclass
class Checkpoint:
    path: str
    tensors: dict  # key -> NumPy array, in the order of the file
    format: str = TORCH
    layers: list = dataclasses.field(default_factory=list)  # of Keras: lines about each
    epsilons: dict = dataclasses.field(default_factory=dict)  # LayerNorm's key -> epsilon, if said
    refused: dict = dataclasses.field(default_factory=dict)  # layer's key -> why it has no tensors
    implied: set = dataclasses.field(default_factory=set)  # keys of zeros and ones not in the file
    notes: list = dataclasses.field(default_factory=list)

    @property
    def name(self):
        return os.path.basename(self.path)

    def why_refused(self, key):
        """Why the layer that `key` names has no tensors, or None."""
        layer = key.rpartition(".")[0]
        return f"{layer} is refused: {self.refused[layer]}" if layer in self.refused else None


def read_checkpoint(path):
    """The Checkpoint in `path`; refuses what is damaged, unusual or hostile."""
    with open(path, "rb") as file:
        begin = file.read(16)
    if begin.startswith(_HDF5):
        from . import keras_h5  # needs h5py, which the other formats do without
        return keras_h5.read(path)
    if begin.startswith(_LEGACY_TORCH):
        raise ConvertError(f"{path}: written by torch.save before PyTorch 1.6, expected its zip "
                           "format; load and save it again with a newer PyTorch")
    if begin.startswith(weights_file.MAGIC):
        raise ConvertError(f"{path}: a gestus weights file, expected a checkpoint")
    if begin.startswith(_ZIP):
        return Checkpoint(path, _without_prefixes(torch_zip.read(path)), TORCH)
    if begin[8:9] == b"{":
        return Checkpoint(path, _without_prefixes(safetensors.read(path)), SAFETENSORS)
    raise ConvertError(f"{path}: no checkpoint of torch.save, safetensors or Keras HDF5")


def _without_prefixes(tensors):
    stripped = True
    while stripped:
        stripped = False
        for prefix in KEY_PREFIXES:
            if all(key.startswith(prefix) for key in tensors):
                tensors = {key[len(prefix):]: value for key, value in tensors.items()}
                stripped = True
    return tensors
