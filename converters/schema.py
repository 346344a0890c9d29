"""Metadata of weights files, between Python dictionaries and FlatBuffers, through flatc.

engine/schema/weights.fbs is the only description of the metadata: field names, defaults and enum
values all come from it, so nothing here repeats them.
"""

import json
import pathlib
import re
import struct
import subprocess
import tempfile

from .errors import ConvertError

SCHEMA = pathlib.Path(__file__).resolve().parent.parent / "engine" / "schema" / "weights.fbs"

_FLOAT_FIELD = re.compile(r"^(\s*)(\w+):\s*(\[float\]|float)(\s*=\s*([-+.\deE]+))?", re.MULTILINE)


def to_flatbuffer(metadata):
    """Bytes of the FlatBuffer that holds `metadata`, a dictionary with the schema's field names."""
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "metadata.json"
        source.write_text(json.dumps(metadata))
        _flatc("--binary", "--strict-json", "-o", folder, SCHEMA, source)
        return source.with_suffix(".fb").read_bytes()


def from_flatbuffer(data):
    """The inverse: every scalar field is present, defaults included; floats are exact.

    The caller has checked the file's checksum: flatc reads what it is given.
    """
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "metadata.fb"
        source.write_bytes(data)
        schema, float_fields = _bit_exact_schema()
        bits = pathlib.Path(folder) / "bits.fbs"
        bits.write_text(schema)
        _flatc("--json", "--strict-json", "--raw-binary", "--defaults-json", "-o", folder, bits,
               "--", source)
        return _bits_to_floats(json.loads(source.with_suffix(".json").read_text()), float_fields)


def complete(network):
    """`network` (fields of the schema's table Network) with all defaults filled in and every name
    and enum value checked against the schema."""
    data = to_flatbuffer({"networks": [network], "tensors": [], "provenance": {}})
    return from_flatbuffer(data)["networks"][0]


def _flatc(*arguments):
    try:
        done = subprocess.run(["flatc", *map(str, arguments)], capture_output=True, text=True,
                              check=False)
    except FileNotFoundError:
        raise ConvertError("flatc: not found, install flatbuffers-compiler") from None
    if done.returncode != 0:
        # "error:", then "  FILE:1: COLUMN: error: unknown field: x"
        found = re.search(r"error: (.*)", done.stderr + done.stdout)
        raise ConvertError("configuration: " + (found[1] if found else "flatc refuses it"))


def _bit_exact_schema():
    """The schema with each float as a uint of the same bits, and the names of these fields.

    flatc prints floats with six decimals, which would lose 1e-12; it prints integers exactly.
    """
    text = SCHEMA.read_text()
    names = set()

    def as_bits(match):
        indent, name, kind, _, default = match.groups()
        names.add(name)
        if kind == "[float]":
            return f"{indent}{name}: [uint]"
        bits = struct.unpack("<I", struct.pack("<f", float(default or 0)))[0]
        return f"{indent}{name}: uint = {bits}"

    return _FLOAT_FIELD.sub(as_bits, text), names


def _bits_to_floats(node, names, name=None):
    if isinstance(node, dict):
        return {key: _bits_to_floats(value, names, key) for key, value in node.items()}
    if isinstance(node, list):
        return [_bits_to_floats(value, names, name) for value in node]
    if name in names:
        return struct.unpack("<f", struct.pack("<I", node))[0]
    return node
