"""Writer and checked reader of weights files; docs/format.md describes the bytes.

The same networks, tensors and provenance always give the same file, byte for byte.
"""

import os
import struct
import tempfile

import numpy as np
import xxhash

from . import schema
from .errors import ConvertError
from .quantised import Quantised

MAGIC = b"GESTUSW\0"
FORMAT_VERSION = 1
ENDIAN_MARK = 0x01020304
ALIGN = 64
HEADER = struct.Struct("<8sIIQQQ16xQ")
CHECKSUM_OFFSET = 56
MAX_NAME = 255
MAX_RANK = 4
MAX_DIM = 1 << 24
SCALE = ".scale"   # behind the name of a tensor of I8: that of its scales

_DTYPES = {"F32": np.dtype("<f4"), "I32": np.dtype("<i4"), "U8": np.dtype("u1")}
_DTYPE_NAMES = {dtype: name for name, dtype in _DTYPES.items()}
# In memory these are a Quantised each.
_QUANTISED = {"BF16": np.dtype("<u2"), "I8": np.dtype("i1")}
MAX_I8_DEPTH = 1 << 16


def align(size):
    return (size + ALIGN - 1) // ALIGN * ALIGN


def write(path, networks, tensors, provenance):
    """Writes `tensors` (name -> array or Quantised, in this order), the `networks` and the
    `provenance` (dictionaries with the schema's field names) to `path`, all or nothing."""
    records, arrays, data_size = [], [], 0
    for name, tensor in tensors.items():
        parts = [(name, tensor)]
        if isinstance(tensor, Quantised) and tensor.scale is not None:
            if name + SCALE in tensors:
                raise ConvertError(f"tensor {name + SCALE}: the name of the scales of {name}")
            parts.append((name + SCALE, tensor.scale))
        for key, part in parts:
            records.append(_record(key, part, data_size))
            arrays.append(part.values if isinstance(part, Quantised) else part)
            data_size = align(data_size + arrays[-1].nbytes)
    data_size += ALIGN
    metadata = schema.to_flatbuffer(
        {"networks": networks, "tensors": records, "provenance": provenance})
    data_offset = align(HEADER.size + len(metadata))

    def header(checksum):
        return HEADER.pack(MAGIC, FORMAT_VERSION, ENDIAN_MARK, data_offset + data_size,
                           len(metadata), data_size, checksum)

    def blocks():
        yield metadata + bytes(data_offset - HEADER.size - len(metadata))
        for array in arrays:
            yield np.ascontiguousarray(array).reshape(-1).view(np.uint8).data
            yield bytes(align(array.nbytes) - array.nbytes)
        yield bytes(ALIGN)

    digest = xxhash.xxh3_64(header(0))
    for block in blocks():
        digest.update(block)
    replace_file(path, [header(digest.intdigest()), *blocks()])


def _record(name, array, offset):
    if not name or len(name) > MAX_NAME or not (name.isascii() and name.isprintable()):
        raise ConvertError(f"tensor {name!r}: expected 1 to {MAX_NAME} printable ASCII characters")
    if isinstance(array, Quantised):
        record = {"dtype": array.dtype, "scale": name + SCALE} if array.scale is not None else {
            "dtype": array.dtype}
        array.check(name, MAX_I8_DEPTH)
        return {"name": name, **record, "shape": list(array.shape), "offset": offset,
                "bytes": array.values.nbytes}
    if array.dtype not in _DTYPE_NAMES:
        raise ConvertError(f"tensor {name}: dtype {array.dtype}, expected float32, int32 or uint8")
    if array.ndim > MAX_RANK or not all(1 <= n <= MAX_DIM for n in array.shape):
        raise ConvertError(f"tensor {name}: shape {array.shape}, expected at most {MAX_RANK} "
                           f"dimensions of 1 to {MAX_DIM}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise ConvertError(f"tensor {name}: holds NaN or infinity, expected finite weights")
    return {"name": name, "dtype": _DTYPE_NAMES[array.dtype], "shape": list(array.shape),
            "offset": offset, "bytes": array.nbytes}


def replace_file(path, blocks):
    """Writes `blocks` beside `path` and renames: `path` is the old file or the whole new one."""
    folder = os.path.dirname(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(prefix=".gestus-", dir=folder)
    try:
        with os.fdopen(handle, "wb") as file:
            for block in blocks:
                file.write(block)
            file.flush()
            os.fsync(file.fileno())
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


class WeightsFile:
    """A file that has passed the checks of `read`: header fields, metadata and tensors by name:
    arrays, or Quantised with the scales that belong to them."""

    def __init__(self, header, metadata, tensors):
        self.header = header
        self.metadata = metadata
        self.tensors = tensors

    @property
    def networks(self):
        return self.metadata["networks"]

    @property
    def provenance(self):
        return self.metadata["provenance"]

    def network_tensors(self, network):
        """Tensors of one network, without its prefix and without its self-test vectors; quantised
        ones as the float32 numbers that they stand for."""
        prefix = network["prefix"]
        test = network.get("self_test")
        skipped = {*test["inputs"], test["output"]} if test else set()
        return {name[len(prefix):]: array.float32() if isinstance(array, Quantised) else array
                for name, array in self.tensors.items()
                if name.startswith(prefix) and name not in skipped}


def read(path):
    """Opens `path` and checks header, checksum and every tensor record; refuses what differs."""
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        if size < HEADER.size + ALIGN:
            raise ConvertError(f"{path}: {size} bytes, expected a weights file")
        data = np.memmap(file, dtype=np.uint8, mode="r")
    header = _check_header(path, bytes(data[:HEADER.size]), size)
    digest = xxhash.xxh3_64(bytes(data[:CHECKSUM_OFFSET]) + bytes(8))
    digest.update(data[HEADER.size:])
    if digest.intdigest() != header["checksum"]:
        raise ConvertError(f"{path}: checksum: the content does not match it, the file is damaged")
    end = HEADER.size + header["metadata_size"]
    if data[end:align(end)].any():
        raise ConvertError(f"{path}: bytes between metadata and data are not zero")
    metadata = schema.from_flatbuffer(bytes(data[HEADER.size:end]))
    region = data[align(end):]
    tensors, position = {}, 0
    for record in metadata["tensors"]:
        tensors[record["name"]], position = _tensor(path, record, region, position, tensors)
    if region[position:].any() or region.size != position + ALIGN:
        raise ConvertError(f"{path}: the data region does not end with {ALIGN} zero bytes")
    return WeightsFile(header, metadata, _with_scales(path, metadata["tensors"], tensors))


def _with_scales(path, records, tensors):
    """`tensors` with the scales inside the tensors that they belong to."""
    taken = {}
    for record in records:
        name, scale = record["name"], record.get("scale", "")
        where = f"{path}: tensor {name}: "
        if bool(scale) != (record["dtype"] == "I8"):
            raise ConvertError(where + ("has a scale, which only I8 has" if scale
                                        else "I8 without a scale"))
        if scale in taken:
            raise ConvertError(where + f"scale {scale} belongs to {taken[scale]} too")
        if scale:
            if scale not in tensors:
                raise ConvertError(where + f"scale {scale}: no such tensor")
            if isinstance(tensors[scale], Quantised):
                raise ConvertError(where + f"scale {scale}: expected float32")
            taken[scale] = name
            tensors[name].scale = tensors[scale]
        if isinstance(tensors[name], Quantised):
            tensors[name].check(f"{name}", MAX_I8_DEPTH, f"{path}: ")
    return {name: tensor for name, tensor in tensors.items() if name not in taken}


def _check_header(path, raw, size):
    magic, version, mark, file_size, metadata_size, data_size, checksum = HEADER.unpack(raw)
    if magic != MAGIC:
        raise ConvertError(f"{path}: no gestus weights file, expected it to begin with GESTUSW")
    if mark != ENDIAN_MARK:
        raise ConvertError(f"{path}: byte order mark is damaged")
    if version != FORMAT_VERSION:
        raise ConvertError(f"{path}: format version {version}, expected {FORMAT_VERSION}")
    if file_size != size:
        raise ConvertError(f"{path}: {size} bytes, expected {file_size}; truncated?")
    if any(raw[40:CHECKSUM_OFFSET]):
        raise ConvertError(f"{path}: reserved header bytes are not zero")
    if not 16 <= metadata_size <= size - HEADER.size:
        raise ConvertError(f"{path}: metadata size {metadata_size} is out of range")
    if align(HEADER.size + metadata_size) + data_size != size or data_size % ALIGN:
        raise ConvertError(f"{path}: data size {data_size} does not fit the file")
    return {"format_version": version, "file_size": file_size, "metadata_size": metadata_size,
            "data_size": data_size, "checksum": checksum}


def _tensor(path, record, region, position, known):
    """The array of one record, and where the next payload may begin."""
    name, shape = record["name"], tuple(record.get("shape", []))
    where = f"{path}: tensor {name}: "
    if name in known:
        raise ConvertError(where + "name is used twice")
    known_types = _DTYPES | _QUANTISED
    if record["dtype"] not in known_types:
        raise ConvertError(where + f"dtype {record['dtype']}, expected {', '.join(known_types)}")
    dtype = known_types[record["dtype"]]
    size = dtype.itemsize
    for dim in shape:
        size *= dim
    begin, end = record["offset"], record["offset"] + size
    fits = len(shape) <= MAX_RANK and all(1 <= n <= MAX_DIM for n in shape)
    if not fits or size != record["bytes"]:
        raise ConvertError(where + f"{record['bytes']} bytes do not fit shape {shape}")
    if begin % ALIGN or begin < position or align(end) + ALIGN > region.size:
        raise ConvertError(where + f"payload at {begin} overlaps another or ends outside the file")
    if region[end:align(end)].any():
        raise ConvertError(where + "padding is not zero")
    array = region[begin:end].view(dtype).reshape(shape)
    if record["dtype"] in _QUANTISED:
        return Quantised(record["dtype"], array), align(end)
    return array, align(end)
