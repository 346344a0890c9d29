"""Reading safetensors, written here by hand; what is damaged or made to do harm is refused."""

import json
import random
import struct

import numpy as np
import pytest

from converters.checkpoint import SAFETENSORS, read_checkpoint
from converters.errors import ConvertError

DTYPES = {"F64": "<f8", "F32": "<f4", "F16": "<f2", "I64": "<i8", "I32": "<i4", "I16": "<i2",
          "I8": "i1", "U8": "u1", "BOOL": "?"}
NAMES = {np.dtype(dtype): name for name, dtype in DTYPES.items()}


def encode(arrays, metadata=None):
    """The bytes that the format's own library would write: data in order, header padded to 8."""
    header, data = {} if metadata is None else {"__metadata__": metadata}, b""
    for key, x in arrays.items():
        header[key] = {"dtype": NAMES[x.dtype], "shape": list(x.shape),
                       "data_offsets": [len(data), len(data) + x.nbytes]}
        data += x.tobytes()
    return raw(json.dumps(header), data)


def raw(header, data=b""):
    text = header.encode()
    text += b" " * (-len(text) % 8)
    return struct.pack("<Q", len(text)) + text + data


@pytest.fixture
def read(tmp_path):
    def read(content):
        path = tmp_path / "model.bin"  # known by its content
        path.write_bytes(content)
        return read_checkpoint(str(path))
    return read


@pytest.mark.parametrize("name", DTYPES)
def test_reads_every_dtype(read, name):
    want = {"a": np.array([[0, 1, 2], [3, 100, 7]]).astype(DTYPES[name]),
            "b": np.array(1).astype(DTYPES[name])}
    got = read(encode(want, {"format": "pt"}))
    assert got.format == SAFETENSORS and list(got.tensors) == ["a", "b"]
    for key, x in want.items():
        assert got.tensors[key].dtype == x.dtype and got.tensors[key].shape == x.shape
        np.testing.assert_array_equal(got.tensors[key], x)


def test_bfloat16_is_widened(read):
    want = np.array([1.0, -2.5, 3e38], "<f4")
    half = (want.view("<u4") >> 16).astype("<u2")
    got = read(raw('{"x": {"dtype": "BF16", "shape": [3], "data_offsets": [0, 6]}}',
                   half.tobytes())).tensors["x"]
    assert got.dtype == np.float32
    np.testing.assert_array_equal(got, (half.astype("<u4") << 16).view("<f4"))


def test_prefix_of_all_keys_is_taken_off(read):
    x = np.ones(2, np.float32)
    assert list(read(encode({"module.a": x, "module.b": x})).tensors) == ["a", "b"]


def entry(dtype="F32", shape="[2]", offsets="[0, 8]"):
    return f'{{"dtype": "{dtype}", "shape": {shape}, "data_offsets": {offsets}}}'


def one(**fields):
    return f'{{"x": {entry(**fields)}}}'


def two(first, second):
    return f'{{"x": {entry(offsets=first)}, "y": {entry(offsets=second)}}}'


EIGHT = bytes(8)
MALFORMED = {
    "length_2_63": (struct.pack("<Q", 1 << 63) + b'{"x":', "header of 9223372036854775808"),
    "length_all_ones": (b"\xff" * 8 + b"{}", "header of"),
    "length_over_limit": (struct.pack("<Q", 100_000_001) + b"{}", "header of 100000001"),
    "length_over_file": (struct.pack("<Q", 3) + b"{}", "header of 3"),
    "length_one": (struct.pack("<Q", 1) + b"{}", "header of 1"),
    "no_header": (bytes(7), "no checkpoint"),
    "no_json": (raw("{x}"), "no JSON"),
    "no_utf8": (struct.pack("<Q", 8) + b'{"\xff": 1}', "no JSON"),
    "nan": (raw('{"x": NaN}'), "holds NaN"),
    "trailing_json": (raw("{}{}"), "no JSON"),
    "deep": (raw('{"x": ' + "[" * 100_000), "nested too deeply"),
    "deep_objects": (raw('{"x":' * 60_000), "nested too deeply"),
    "too_many_brackets": (raw('{"x": ' + "[" * 200_000), "more than 131072"),
    "too_many_commas": (raw('{"x": [' + "0," * 1_100_000 + "0]}"), "more than 1048576"),
    "long_number": (raw('{"x": ' + "9" * 10_000 + "}"), "no JSON"),
    "key_twice": (raw(two("[0, 8]", "[8, 16]").replace('"y"', '"x"'), bytes(16)), "'x' is there"),
    "field_twice": (raw('{"x": {"dtype": "F32", "dtype": "F32", "shape": [2], '
                        '"data_offsets": [0, 8]}}', EIGHT), "'dtype' is there twice"),
    "metadata_number": (raw('{"__metadata__": {"a": 1}, "x": ' + entry() + "}", EIGHT),
                        "no object of strings"),
    "metadata_list": (raw('{"__metadata__": [], "x": ' + entry() + "}", EIGHT),
                      "no object of strings"),
    "no_tensors": (raw("{}"), "0 tensors"),
    "only_metadata": (raw('{"__metadata__": {}}'), "0 tensors"),
    "entry_is_list": (raw('{"x": []}'), "expected dtype"),
    "field_missing": (raw('{"x": {"dtype": "F32", "shape": [2]}}'), "expected dtype"),
    "field_more": (raw('{"x": {"dtype": "F32", "shape": [2], "data_offsets": [0, 8], "a": 1}}',
                       EIGHT), "expected dtype"),
    "dtype_unknown": (raw(one(dtype="F8_E4M3"), EIGHT), "dtype F8_E4M3"),
    "dtype_is_list": (raw(one().replace('"F32"', '["F32"]'), EIGHT), "expected one of"),
    "shape_is_number": (raw(one(shape="2"), EIGHT), "expected a shape"),
    "shape_negative": (raw(one(shape="[-2]"), EIGHT), "expected a shape"),
    "shape_bool": (raw(one(shape="[true, 2]"), EIGHT), "expected a shape"),
    "shape_float": (raw(one(shape="[2.0]"), EIGHT), "expected a shape"),
    "shape_rank": (raw(one(shape="[2, 1, 1, 1, 1, 1, 1, 1, 1]"), EIGHT), "expected a shape"),
    "shape_wraps": (raw(one(shape="[4294967296, 4294967296, 2]"), EIGHT), "expected 1475739525896"),
    "shape_huge": (raw(one(shape="[99999999999999999999]"), EIGHT), "expected a shape"),
    "shape_smaller": (raw(one(shape="[1]"), EIGHT), "8 bytes for F32"),
    "empty_tensor": (raw(one(shape="[0]", offsets="[0, 0]")), "0 bytes for F32"),
    "offsets_three": (raw(one(offsets="[0, 4, 8]"), EIGHT), "two offsets"),
    "offsets_negative": (raw(one(offsets="[-8, 0]"), EIGHT), "two offsets"),
    "offsets_reversed": (raw(one(offsets="[8, 0]"), EIGHT), "-8 bytes"),
    "overlap": (raw(two("[0, 8]", "[4, 12]"), bytes(12)), "begins at 4, expected 8"),
    "same_bytes": (raw(two("[0, 8]", "[0, 8]"), EIGHT), "begins at 0, expected 8"),
    "gap": (raw(two("[0, 8]", "[12, 20]"), bytes(20)), "begins at 12, expected 8"),
    "hole_at_the_front": (raw(one(offsets="[4, 12]"), bytes(12)), "begins at 4, expected 0"),
    "trailing_bytes": (raw(one(), bytes(9)), "end at 8, expected the end of the data at 9"),
    "truncated": (raw(one(), bytes(7)), "end at 8, expected the end of the data at 7"),
    "name_empty": (raw('{"": ' + entry() + "}", EIGHT), "printable"),
    "name_long": (raw('{"' + "x" * 256 + '": ' + entry() + "}", EIGHT), "1 to 255 printable"),
    "name_escape": (raw(r'{"\u001b[31m": ' + entry() + "}", EIGHT), "printable"),
    "name_surrogate": (raw(r'{"\ud800": ' + entry() + "}", EIGHT), "printable"),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed(read, name):
    content, message = MALFORMED[name]
    with pytest.raises(ConvertError, match=message) as caught:
        read(content)
    text = str(caught.value)
    assert text.isprintable() and len(text) < 400


def test_too_many_tensors(read):
    header = {f"t{i}": {"dtype": "U8", "shape": [1], "data_offsets": [i, i + 1]}
              for i in range((1 << 16) + 3)}
    with pytest.raises(ConvertError, match="expected at most 65536 tensors"):
        read(raw(json.dumps(header), bytes(len(header))))


def test_every_truncation_is_refused(read):
    good = encode({"x": np.arange(5, dtype=np.float32)})
    for length in range(len(good)):
        with pytest.raises(ConvertError):
            read(good[:length])


def test_mutated_headers(read):
    """Seeded mutations of a good file: refused in a sentence, or arrays that fit the file."""
    good = encode({"a.weight": np.ones((2, 3), np.float32), "b": np.arange(4, dtype=np.int64)},
                  {"format": "pt"})
    pieces = [b"{", b"}", b"[", b"]", b",", b":", b'"', b"0", b"-1", b"1e9", b"NaN", b"null",
              b'"a.weight"', b'"dtype"', b"[0, 24]", b"[24, 56]", b"\x00", b"\xff",
              b"\\ud800", b"9" * 20]
    source = random.Random(20231)
    for _ in range(3000):
        data = bytearray(good)
        for _ in range(source.randint(1, 3)):
            at = source.randrange(len(data))
            kind = source.randrange(3)
            if kind == 0:
                data[at] ^= 1 << source.randrange(8)
            elif kind == 1:
                data[at:at + source.randint(0, 8)] = source.choice(pieces)
            else:
                del data[at:at + source.randint(1, 8)]
        if source.random() < 0.5 and len(data) > 64:  # the length repaired: further into the parser
            end = data.find(b"}}", 8)
            data[:8] = struct.pack("<Q", max(end + 2 - 8, 2))
        try:
            tensors = read(bytes(data)).tensors
        except ConvertError:
            continue
        assert sum(x.nbytes for x in tensors.values()) <= len(data)
