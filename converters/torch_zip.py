"""Reads the tensors of a PyTorch checkpoint without PyTorch and without running what is in it.

A checkpoint is a zip archive of one pickle and one member for each storage.  A pickle is a program;
ours may call three constructors that make inert records, and nothing else.
"""

import io
import math
import os
import pickle
import struct
import zipfile
from typing import NamedTuple

import numpy as np

from .errors import ConvertError

MAX_PICKLE_BYTES = 64 << 20
MAX_NODES = 1 << 20
MAX_DEPTH = 16
MAX_RANK = 8

# Where training scripts put the state_dict, the first that is there.
WRAPPERS = ("state_dict", "model_state_dict", "model", "net", "network", "weights", "generator")

class StorageType(NamedTuple):
    name: str
    dtype: str  # of the bytes; bfloat16 is read as its upper half of binary32


class Storage(NamedTuple):
    type: StorageType
    member: str
    length: int  # in elements


class Tensor(NamedTuple):
    storage: Storage
    offset: int
    size: tuple
    stride: tuple


_STORAGES = {name + "Storage": StorageType(name, dtype) for name, dtype in {
    "Float": "<f4", "Double": "<f8", "Half": "<f2", "BFloat16": "<u2", "Long": "<i8", "Int": "<i4",
    "Short": "<i2", "Char": "i1", "Byte": "u1", "Bool": "?"}.items()}


def read(path):
    """The tensors of the state_dict in `path`, key -> NumPy array in the order of the file; refuses
    what is damaged, unusual or hostile."""
    with open(path, "rb") as file:
        try:
            with zipfile.ZipFile(file) as archive:
                return _read_archive(path, archive)
        # What zipfile raises for archives that are damaged, encrypted or made to confuse it.
        except (zipfile.BadZipFile, EOFError, NotImplementedError, OSError, RuntimeError,
                ValueError, struct.error) as error:
            raise ConvertError(f"{path}: no checkpoint of torch.save or damaged: "
                               f"{error}") from None


def _read_archive(path, archive):
    members, prefix = _members(path, archive)
    root = _unpickle(path, archive.read(members[prefix + "data.pkl"]), members, prefix)
    loader = _Loader(path, archive, members)
    return {key: loader.array(key, tensor) for key, tensor in _state_dict(path, root).items()}


def _members(path, archive):
    """Members by name and the folder of data.pkl; every size is proven by the file's."""
    members, total = {}, 0
    if {"config.json", "model.weights.h5"} <= set(archive.namelist()):
        raise ConvertError(f"{path}: a .keras archive, expected Keras' HDF5; load it and save it "
                           "with model.save(\"model.h5\")")
    if any(name.split("/")[-1] == "constants.pkl" for name in archive.namelist()):
        raise ConvertError(f"{path}: a TorchScript archive, expected a checkpoint with the "
                           "state_dict")
    for info in archive.infolist():
        if info.filename in members:
            raise ConvertError(f"{path}: member {info.filename} is there twice")
        if info.compress_type != zipfile.ZIP_STORED or info.compress_size != info.file_size:
            raise ConvertError(f"{path}: member {info.filename} is compressed, expected it stored "
                               "as torch.save does")
        members[info.filename] = info
        total += info.file_size
    if total > os.path.getsize(path):
        raise ConvertError(f"{path}: members claim {total} bytes, more than the file has")
    pickles = [name for name in members if name.split("/")[-1] == "data.pkl"]
    if len(pickles) != 1 or pickles[0].count("/") > 1:
        raise ConvertError(f"{path}: {len(pickles)} members data.pkl, expected one as in a "
                           "checkpoint of torch.save")
    prefix = pickles[0][:-len("data.pkl")]
    order = members.get(prefix + "byteorder")
    if order is not None and archive.read(order).strip() != b"little":
        raise ConvertError(f"{path}: written on a big-endian machine, expected little endian")
    if members[pickles[0]].file_size > MAX_PICKLE_BYTES:
        raise ConvertError(f"{path}: data.pkl has {members[pickles[0]].file_size} bytes, expected "
                           f"at most {MAX_PICKLE_BYTES}")
    return members, prefix


# ------------------------------------------------------------------------------------- the pickle


def _rebuild_tensor(storage, offset, size, stride, *_):
    return Tensor(storage, offset, size, stride)


def _rebuild_parameter(data, *_):
    return data


def _inert(*_):
    """Devices, dtypes, sizes: part of training checkpoints, of no use here."""


_GLOBALS = {
    ("collections", "OrderedDict"): lambda *items: dict(*items),
    ("torch._utils", "_rebuild_tensor_v2"): _rebuild_tensor,
    ("torch._utils", "_rebuild_parameter"): _rebuild_parameter,
    ("torch", "Size"): _inert,
    ("torch", "device"): _inert,
    **{("torch", name): kind for name, kind in _STORAGES.items()},
    **{("torch", name): _inert for name in ("float32", "float64", "float16", "bfloat16", "int64",
                                            "int32", "int16", "int8", "uint8", "bool")},
}


# The unpickler in Python: the one in C reserves memory for any index that a memo opcode names.
class _Unpickler(pickle._Unpickler):  # pylint: disable=protected-access
    def __init__(self, path, data, members, prefix):
        super().__init__(io.BytesIO(data), encoding="utf-8", errors="strict")
        self.path, self.members, self.prefix = path, members, prefix

    dispatch = dict(pickle._Unpickler.dispatch)  # pylint: disable=protected-access

    def load_build(self):
        """State of an instance: the `_metadata` of a state_dict.  Nothing here has any."""
        self.stack.pop()

    dispatch[pickle.BUILD[0]] = load_build

    def find_class(self, module, name):
        if (module, name) not in _GLOBALS:
            raise ConvertError(f"{self.path}: asks for {module}.{name}, expected tensors only; "
                               "save model.state_dict() instead of whole objects")
        return _GLOBALS[module, name]

    def get_extension(self, code):
        raise ConvertError(f"{self.path}: asks for pickle extension {code}, expected tensors only")

    def persistent_load(self, pid):
        if not (isinstance(pid, tuple) and len(pid) == 5 and pid[0] == "storage"
                and isinstance(pid[1], StorageType) and isinstance(pid[2], str)
                and _is_size(pid[4])):
            raise ConvertError(f"{self.path}: a storage is described in an unknown way")
        storage = Storage(pid[1], self.prefix + "data/" + pid[2], pid[4])
        info = self.members.get(storage.member)
        if info is None:
            raise ConvertError(f"{self.path}: member {storage.member} is missing")
        if storage.length * np.dtype(storage.type.dtype).itemsize > info.file_size:
            raise ConvertError(f"{self.path}: member {storage.member} has {info.file_size} bytes, "
                               f"expected {storage.length} elements of {storage.type.name}")
        return storage


def _unpickle(path, data, members, prefix):
    try:
        return _Unpickler(path, data, members, prefix).load()
    except ConvertError:
        raise
    except Exception as error:  # pylint: disable=broad-except
        # What a damaged pickle raises has no end: any exception means the same.
        raise ConvertError(f"{path}: data.pkl is damaged: {type(error).__name__}: "
                           f"{str(error)[:80]}") from None


# --------------------------------------------------------------------------------- the state_dict


def _state_dict(path, root):
    """key -> Tensor: the state_dict inside `root`."""
    if not isinstance(root, dict):
        raise ConvertError(f"{path}: holds a {type(root).__name__}, expected a state_dict")
    if not any(isinstance(value, Tensor) for value in root.values()):
        for name in WRAPPERS:
            if isinstance(root.get(name), dict):
                root = root[name]
                break
    tensors = {}
    _flatten(path, root, "", tensors, [0], 0)
    if not tensors:
        raise ConvertError(f"{path}: holds no tensors, expected a state_dict")
    return tensors


def _flatten(path, node, key, tensors, count, depth):
    count[0] += 1
    if count[0] > MAX_NODES or depth > MAX_DEPTH:
        raise ConvertError(f"{path}: nested too deeply or too widely for a state_dict")
    if isinstance(node, Tensor):
        if key in tensors:
            raise ConvertError(f"{path}: tensor {key} is there twice")
        tensors[key] = node
    elif isinstance(node, (dict, list)):
        for name, child in node.items() if isinstance(node, dict) else enumerate(node):
            if not isinstance(name, (str, int)):
                raise ConvertError(f"{path}: a key is a {type(name).__name__}, expected text")
            _flatten(path, child, f"{key}.{name}" if key else str(name), tensors, count, depth + 1)


# ------------------------------------------------------------------------------------ the tensors


class _Loader:
    def __init__(self, path, archive, members):
        self.path, self.archive, self.members = path, archive, members
        self.storages = {}

    def array(self, key, tensor):
        self._check(key, tensor)
        flat = self._elements(tensor.storage)
        itemsize = flat.dtype.itemsize
        view = np.lib.stride_tricks.as_strided(
            flat[tensor.offset:], tensor.size, [step * itemsize for step in tensor.stride],
            writeable=False)
        if tensor.storage.type.name == "BFloat16":
            return (view.astype("<u4") << 16).view("<f4")
        return view

    def _check(self, key, tensor):
        where = f"{self.path}: tensor {key}: "
        if not (isinstance(tensor.storage, Storage) and _is_size(tensor.offset)
                and _are_sizes(tensor.size) and _are_sizes(tensor.stride)
                and len(tensor.size) == len(tensor.stride) <= MAX_RANK):
            raise ConvertError(where + "described in an unknown way")
        elements, length = math.prod(tensor.size), tensor.storage.length
        last = tensor.offset
        if elements:
            last += sum((n - 1) * step for n, step in zip(tensor.size, tensor.stride)) + 1
        # Distinct elements only: a stride of 0 would make much of little.
        if elements > length or last > length:
            raise ConvertError(where + f"shape {tensor.size} from element {tensor.offset} on does "
                               f"not fit its storage of {length}")

    def _elements(self, storage):
        if storage not in self.storages:
            data = self.archive.read(self.members[storage.member])
            self.storages[storage] = np.frombuffer(data, storage.type.dtype, storage.length)
        return self.storages[storage]


def _is_size(value):
    return type(value) is int and 0 <= value < 1 << 48  # a bool is no size


def _are_sizes(values):
    return isinstance(values, tuple) and all(map(_is_size, values))
