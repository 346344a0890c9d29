"""Reads Keras' HDF5 files of TensorFlow 2: model.save("model.h5") and save_weights.

A group a layer, whose attribute weight_names says which data sets to read.  h5py is asked for plain
numbers and texts that stand in this file under those names, for nothing else, and in a process of
its own: links, references, objects and filters of others are not followed, and no code is run.
"""

import math
import os

from . import isolate, keras_layers, strict_json
from .checkpoint import KERAS, Checkpoint
from .errors import ConvertError

MAX_NAMES = 1 << 16
MAX_CONFIG_BYTES = 64 << 20
MAX_RANK = 8
# How much more the numbers may be than the file: compression gains little on weights.
MAX_RATIO = 16
_SPARE_MEMORY = 512 << 20
_SECONDS = 600

_TOP_LEVEL = "top_level_model_weights"


def read(path):
    """The Checkpoint of a Keras file, its layers' arrays as PyTorch lays them out."""
    try:
        import h5py  # noqa: F401  pylint: disable=unused-import
    except ModuleNotFoundError:
        raise ConvertError(f"{path}: Keras files need h5py (Debian: python3-h5py)") from None
    memory = _SPARE_MEMORY + 2 * MAX_RATIO * os.path.getsize(path)
    (config, names), arrays = isolate.arrays_of(_extract, path, memory, _SECONDS)
    config = config and strict_json.parse(config.encode(), f"{path}: model_config")
    variables = [(group, name, x) for (group, name), x in zip(names, arrays)]
    found = keras_layers.convert(path, config, variables)
    return Checkpoint(path, found.tensors, KERAS, found.layers, found.epsilons, found.refused,
                      found.implied, found.notes)


def _extract(path):
    """((model_config or None, [(layer, name)]), [array]) in the order of the file."""
    import h5py
    try:
        with h5py.File(path, "r") as file:
            return _File(h5py, path, file).read()
    except ConvertError:
        raise
    except Exception as error:  # pylint: disable=broad-except
        # h5py passes on whatever HDF5 reports of a damaged file, as exceptions of many types.
        raise ConvertError(f"{path}: HDF5 is damaged: {type(error).__name__}: "
                           f"{str(error)[:120]}") from None


class _File:
    def __init__(self, h5py, path, file):
        self.h5py, self.path, self.root = h5py, path, file
        self.size = os.path.getsize(path)
        self.budget = MAX_RATIO * self.size

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

    def has(self, group, name):
        return group.id.links.exists(name.encode())

    def inside(self, group, name, kind):
        """What `name`, with its slashes, leads to."""
        *parts, last = name.split("/")
        for part in parts:
            group = self.child(group, part, self.h5py.Group)
        return self.child(group, last, kind)

    def child(self, group, name, kind):
        """The group or data set that stands in `group` itself, not behind a link."""
        where = f"{self.path}: {name[:200]}"
        if not (name.isprintable() and name not in ("", ".", "..") and "/" not in name
                and self.has(group, name)):
            raise ConvertError(f"{where}: missing")
        link = group.id.links.get_info(name.encode()).type
        if link != self.h5py.h5l.TYPE_HARD:
            kinds = {self.h5py.h5l.TYPE_SOFT: "a soft", self.h5py.h5l.TYPE_EXTERNAL: "an external"}
            raise ConvertError(f"{where}: {kinds.get(link, 'an unknown')} link, expected what "
                               "stands in this file")
        found = group[name]
        if not isinstance(found, kind):
            raise ConvertError(f"{where}: a {type(found).__name__}, expected a {kind.__name__}")
        return found

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

    def check(self, found, where):
        h5t, h5d, h5z = self.h5py.h5t, self.h5py.h5d, self.h5py.h5z
        kind, made = found.id.get_type(), found.id.get_create_plist()
        if kind.get_class() not in (h5t.FLOAT, h5t.INTEGER):
            raise ConvertError(where + "expected numbers")
        layout = made.get_layout()
        if layout == h5d.VIRTUAL or made.get_external_count():
            raise ConvertError(where + "its numbers stand in other files")
        shape = found.id.shape
        if shape is None or len(shape) > MAX_RANK:
            raise ConvertError(where + f"expected at most {MAX_RANK} dimensions")
        size = math.prod(shape) * kind.get_size()
        stored, chunk = found.id.get_storage_size(), 0
        if layout == h5d.CHUNKED:
            chunk = math.prod(made.get_chunk()) * kind.get_size()
            filters = {made.get_filter(i)[0] for i in range(made.get_nfilters())}
            if not filters <= {h5z.FILTER_DEFLATE, h5z.FILTER_SHUFFLE, h5z.FILTER_FLETCHER32}:
                raise ConvertError(where + "filters other than gzip and shuffle")
        elif stored != size:
            raise ConvertError(where + f"{stored} bytes for shape {shape}, expected {size}")
        self.budget -= size
        if self.budget < 0 or chunk > MAX_RATIO * self.size or not stored:
            raise ConvertError(where + f"shape {shape} is more than a file of {self.size} bytes "
                               "can hold")
