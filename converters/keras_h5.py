"""Reads Keras' HDF5 files of TensorFlow 2: model.save("model.h5") and save_weights.

A group a layer, whose attribute weight_names says which data sets to read.  h5py is asked for plain
numbers and texts that stand in this file under those names, for nothing else, and in a process of
its own: links, references, objects and filters of others are not followed, and no code is run.
"""

from . import hdf5, isolate, keras_layers, strict_json
from .checkpoint import KERAS, Checkpoint
from .errors import ConvertError

MAX_NAMES = 1 << 16
MAX_CONFIG_BYTES = 64 << 20

_TOP_LEVEL = "top_level_model_weights"


def read(path):
    """The Checkpoint of a Keras file, its layers' arrays as PyTorch lays them out."""
    hdf5.need_h5py(path, "Keras files")
    (config, names), arrays = isolate.arrays_of(_extract, path, hdf5.memory_for(path), hdf5.SECONDS)
    config = config and strict_json.parse(config.encode(), f"{path}: model_config")
    variables = [(group, name, x) for (group, name), x in zip(names, arrays)]
    found = keras_layers.convert(path, config, variables)
    return Checkpoint(path, found.tensors, KERAS, found.layers, found.epsilons, found.refused,
                      found.implied, found.notes)


def _extract(path):
    """((model_config or None, [(layer, name)]), [array]) in the order of the file."""
    return hdf5.read(path, _File)


class _File(hdf5.SafeFile):
    def read(self):
        top, config = self.root, None
        if self.has(top, "model_weights"):
            config = self.text(top, "model_config")
            top = self.child(top, "model_weights", self.h5py.Group)
        if not self.has_texts(top, "layer_names"):
            hint = ("written by Keras 3's save_weights, which is not known; save with "
                    "model.save(\"model.h5\")" if self.has(top, "layers") else
                    "no attribute layer_names, expected a file of Keras")
            raise ConvertError(f"{self.path}: {hint}")
        groups = self.texts(top, "layer_names")
        if _TOP_LEVEL not in groups and self.has(top, _TOP_LEVEL):
            groups.append(_TOP_LEVEL)
        names, arrays = [], []
        for group in groups:
            layer = self.inside(top, group, self.h5py.Group)
            for name in self.texts(layer, "weight_names"):
                names.append((group, name))
                arrays.append(self.array(layer, group, name))
        return (config, names), arrays

    # --------------------------------------------------------------------------------- attributes

    def has_texts(self, group, name):
        return name in group.attrs or name + "0" in group.attrs

    def texts(self, group, name):
        """A list of texts; Keras cuts long ones into attributes name0, name1 and so on."""
        if name in group.attrs:
            return self.attribute(group, name)
        found = []
        while f"{name}{len(found)}" in group.attrs and len(found) < MAX_NAMES:
            found.append(self.attribute(group, f"{name}{len(found)}"))
        if not found:
            raise ConvertError(f"{self.path}: {group.name}: attribute {name} is missing")
        return [text for part in found for text in part]

    def text(self, group, name):
        found = self.attribute(group, name) if name in group.attrs else []
        if len(found) > 1:
            raise ConvertError(f"{self.path}: attribute {name}: {len(found)} texts, expected one")
        return found[0] if found else None

    def attribute(self, group, name):
        where = f"{self.path}: attribute {name} of {group.name}: "
        h5t = self.h5py.h5t
        attribute = self.h5py.h5a.open(group.id, name.encode())
        count = attribute.get_space().get_simple_extent_npoints()
        if count == 0:
            return []  # an empty list has no type that would say it once held texts
        kind = attribute.get_type()
        if kind.get_class() != h5t.STRING:
            raise ConvertError(where + "expected text")
        size = 0 if kind.is_variable_str() else kind.get_size()
        if count > MAX_NAMES or count * size > self.size or size > MAX_CONFIG_BYTES:
            raise ConvertError(where + f"{count} texts of {size} bytes, more than Keras writes")
        value = group.attrs[name]
        found = []
        for item in [value] if isinstance(value, (str, bytes)) else value.reshape(-1).tolist():
            # h5py passes bytes that are no UTF-8 on as surrogates: they raise here.
            text = (item if isinstance(item, bytes) else item.encode("utf-8")).decode("utf-8")
            if len(text) > MAX_CONFIG_BYTES:
                raise ConvertError(where + f"{len(text)} characters, more than Keras writes")
            found.append(text)
        return found

    # ---------------------------------------------------------------------------------- data sets

    def array(self, layer, group, name):
        found = self.inside(layer, name, self.h5py.Dataset)
        self.check(found, f"{self.path}: {group}/{name}: ")
        return found[()]
