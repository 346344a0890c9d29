"""Reads .safetensors: eight bytes of length, a JSON header, the tensors one after another."""

import math
import os
import struct

import numpy as np

from . import strict_json
from .errors import ConvertError

MAX_HEADER_BYTES = 100_000_000
MAX_TENSORS = 1 << 16
MAX_NAME = 255
MAX_RANK = 8
# What a header within these limits needs at most: the parser's memory is bounded before it runs.
_MAX_COUNT = {b"{": MAX_TENSORS + 2, b"[": 2 * MAX_TENSORS, b",": 16 * MAX_TENSORS,
              b'"': 32 * MAX_TENSORS}

# bfloat16 is read as its upper half of binary32.
_DTYPES = {"F64": "<f8", "F32": "<f4", "F16": "<f2", "BF16": "<u2", "I64": "<i8", "I32": "<i4",
           "I16": "<i2", "I8": "i1", "U8": "u1", "BOOL": "?"}


def read(path):
    """key -> NumPy array, in the order of the data; refuses all that is not as specified."""
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        header, length = _header(path, file, size)
        tensors = _tensors(path, header, size - 8 - length)
        data = file.read()
    if len(data) != size - 8 - length:
        raise ConvertError(f"{path}: truncated while it was read")
    return {key: _array(data, *tensor) for key, tensor in tensors.items()}


def _header(path, file, size):
    if size < 8:
        raise ConvertError(f"{path}: {size} bytes, expected a header")
    length, = struct.unpack("<Q", file.read(8))
    if not 2 <= length <= min(MAX_HEADER_BYTES, size - 8):
        raise ConvertError(f"{path}: header of {length} bytes in a file of {size}, expected at "
                           f"most {MAX_HEADER_BYTES} and no more than the file has")
    raw = file.read(length)
    for character, limit in _MAX_COUNT.items():
        if raw.count(character) > limit:
            raise ConvertError(f"{path}: more than {limit} of {character.decode()} in the header, "
                               f"expected at most {MAX_TENSORS} tensors")
    header = strict_json.parse(raw, f"{path}: header")
    if not isinstance(header, dict):
        raise ConvertError(f"{path}: header is no object")
    return header, length


def _tensors(path, header, data_size):
    """key -> (dtype, shape, begin, end) in the order of the data, which they cover exactly."""
    metadata = header.pop("__metadata__", {})
    if not (isinstance(metadata, dict) and all(isinstance(x, str) for x in metadata.values())):
        raise ConvertError(f"{path}: __metadata__ is no object of strings")
    if not 1 <= len(header) <= MAX_TENSORS:
        raise ConvertError(f"{path}: {len(header)} tensors, expected 1 to {MAX_TENSORS}")
    found = [(key, *_entry(path, key, entry)) for key, entry in header.items()]
    found.sort(key=lambda tensor: tensor[3])
    position = 0
    for key, _, _, begin, end in found:
        if begin != position:
            raise ConvertError(f"{path}: tensor {key}: begins at {begin}, expected {position}, "
                               "where the one before ends")
        position = end
    if position != data_size:
        raise ConvertError(f"{path}: tensors end at {position}, expected the end of the data at "
                           f"{data_size}")
    return {key: tensor for key, *tensor in found}


def _entry(path, key, entry):
    if not (1 <= len(key) <= MAX_NAME and key.isprintable()):
        raise ConvertError(f"{path}: tensor {key[:80]!r}: expected 1 to {MAX_NAME} printable "
                           "characters")
    where = f"{path}: tensor {key}: "
    if not (isinstance(entry, dict) and set(entry) == {"dtype", "shape", "data_offsets"}):
        raise ConvertError(where + "expected dtype, shape and data_offsets")
    dtype, shape, offsets = entry["dtype"], entry["shape"], entry["data_offsets"]
    if not (isinstance(dtype, str) and dtype in _DTYPES):
        raise ConvertError(where + f"dtype {str(dtype)[:80]}, expected one of "
                           + ", ".join(_DTYPES))
    if not (_are_sizes(shape) and len(shape) <= MAX_RANK and _are_sizes(offsets)
            and len(offsets) == 2):
        raise ConvertError(where + f"expected a shape of at most {MAX_RANK} sizes and two offsets")
    begin, end = offsets
    wanted = math.prod(shape) * np.dtype(_DTYPES[dtype]).itemsize
    if not wanted or end - begin != wanted:
        raise ConvertError(where + f"{end - begin} bytes for {dtype} of shape {tuple(shape)}, "
                           f"expected {wanted or 'some'}")
    return dtype, tuple(shape), begin, end


def _are_sizes(values):
    # A bool is no size; the bound keeps the product of eight of them printable.
    return isinstance(values, list) and all(type(x) is int and 0 <= x < 1 << 48 for x in values)


def _array(data, dtype, shape, begin, _):
    array = np.frombuffer(data, _DTYPES[dtype], math.prod(shape), begin).reshape(shape)
    if dtype == "BF16":
        return (array.astype("<u4") << 16).view("<f4")
    return array
