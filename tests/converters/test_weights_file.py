"""The bytes of a weights file: layout, determinism, and what the reader refuses."""

import struct

import numpy as np
import pytest
import xxhash

from converters import schema, weights_file
from converters.errors import ConvertError

PROVENANCE = {"trained": False, "recipe": "test"}


def tensors():
    rng = np.random.default_rng(5)
    return {"a": rng.standard_normal((3, 5)).astype(np.float32),
            "b/scalar": np.array(7, np.int32), "c": np.arange(64, dtype=np.uint8),
            "d": rng.standard_normal((1, 2, 3, 4)).astype(np.float32)}


@pytest.fixture
def path(tmp_path, tiny):
    target = tmp_path / "x.fb"
    weights_file.write(target, [tiny], tensors(), PROVENANCE)
    return target


def reseal(data):
    """The same bytes with a right checksum."""
    data = bytearray(data)
    data[56:64] = bytes(8)
    data[56:64] = struct.pack("<Q", xxhash.xxh3_64_intdigest(bytes(data)))
    return bytes(data)


def test_layout(path):
    data = path.read_bytes()
    magic, version, mark, size, metadata, region = struct.unpack_from("<8sIIQQQ", data)
    assert (magic, version, mark, size) == (b"GESTUSW\0", 1, 0x01020304, len(data))
    assert data[40:56] == bytes(16) and data[68:72] == b"GSTW"
    begin = (64 + metadata + 63) // 64 * 64
    assert begin + region == len(data) and region % 64 == 0
    assert not any(data[64 + metadata:begin]) and not any(data[-64:])
    assert reseal(data) == data
    payload = tensors()["a"].tobytes()
    assert data[begin:begin + 64] == payload + bytes(64 - len(payload))


def test_round_trip(path, tiny):
    file = weights_file.read(path)
    for name, want in tensors().items():
        np.testing.assert_array_equal(file.tensors[name], want)
        assert file.tensors[name].dtype == want.dtype and file.tensors[name].shape == want.shape
    assert file.networks[0]["config"] == tiny["config"]
    assert file.provenance["recipe"] == "test"


def test_floats_survive(tiny):
    values = [1e-12, 1 / 3, -7.123456789, 3.4e38, 1e-38]
    tiny["normalisations"] = [{"stream": "speech", "mean": values, "deviation": values,
                               "divisor": 0.1}]
    tiny["config"]["ast_content"]["ln_eps"] = 1e-12
    got = schema.complete(tiny)
    as_float32 = [float(np.float32(v)) for v in values]
    assert got["normalisations"][0]["mean"] == as_float32
    assert got["normalisations"][0]["divisor"] == float(np.float32(0.1))
    assert got["config"]["ast_content"]["ln_eps"] == float(np.float32(1e-12))


def test_defaults_are_those_of_the_schema():
    config = schema.complete({"name": "n", "prefix": "", "config_type": "AstConfig",
                              "config": {}})["config"]
    assert config["d_model"] == 768 and config["ln_eps"] == float(np.float32(1e-6))
    assert config["pool"] == "Cls"


def test_same_input_same_bytes(path, tmp_path, tiny):
    weights_file.write(tmp_path / "y.fb", [tiny], tensors(), PROVENANCE)
    assert (tmp_path / "y.fb").read_bytes() == path.read_bytes()
    changed = tensors()
    changed["a"][0, 0] = np.nextafter(changed["a"][0, 0], np.float32(9))
    weights_file.write(tmp_path / "y.fb", [tiny], changed, PROVENANCE)
    assert (tmp_path / "y.fb").read_bytes()[56:64] != path.read_bytes()[56:64]


def test_no_tensors(tmp_path, tiny):
    weights_file.write(tmp_path / "y.fb", [tiny], {}, PROVENANCE)
    assert weights_file.read(tmp_path / "y.fb").header["data_size"] == 64


@pytest.mark.parametrize("array, message", [
    (np.zeros(3, np.float64), "float64, expected"),
    (np.zeros((1,) * 5, np.float32), "at most 4 dimensions"),
    (np.zeros((2, 0), np.float32), "dimensions of 1 to"),
    (np.array([1, np.nan], np.float32), "NaN or infinity"),
    (np.array([1, np.inf], np.float32), "NaN or infinity"),
])
def test_writer_refuses(tmp_path, tiny, array, message):
    with pytest.raises(ConvertError, match=message):
        weights_file.write(tmp_path / "y.fb", [tiny], {"x": array}, PROVENANCE)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["", "x" * 256, "tab\t", "ümlaut"])
def test_writer_refuses_names(tmp_path, tiny, name):
    with pytest.raises(ConvertError, match="printable ASCII"):
        weights_file.write(tmp_path / "y.fb", [tiny], {name: np.zeros(1, np.float32)}, PROVENANCE)


def test_failed_write_leaves_the_old_file(path, monkeypatch, tiny):
    before = path.read_bytes()

    def full(_):
        raise OSError(28, "No space left on device")
    monkeypatch.setattr(weights_file.os, "fsync", full)
    with pytest.raises(OSError):
        weights_file.write(path, [tiny], tensors(), PROVENANCE)
    assert path.read_bytes() == before and len(list(path.parent.iterdir())) == 1


def test_every_truncation_and_many_flips_are_refused(path):
    data = path.read_bytes()
    rng = np.random.default_rng(6)
    for length in range(0, len(data), 7):
        path.write_bytes(data[:length])
        with pytest.raises(ConvertError):
            weights_file.read(path)
    for position in [*range(64), *rng.integers(64, len(data), 100)]:
        path.write_bytes(data[:position] + bytes([data[position] ^ 1 << position % 8])
                         + data[position + 1:])
        with pytest.raises(ConvertError):
            weights_file.read(path)


@pytest.mark.parametrize("offset, value, message", [
    (0, b"X", "no gestus weights file"),
    (8, b"\x02", "format version 2"),
    (12, b"\x01", "byte order"),
    (16, b"\x01", "truncated"),
    (24, b"\xff\xff\xff", "metadata size"),
    (32, b"\x01", "data size"),
    (41, b"\x01", "reserved"),
    (-1, b"\x01", "end with 64 zero"),
])
def test_reader_names_the_field(path, offset, value, message):
    data = bytearray(path.read_bytes())
    offset %= len(data)
    data[offset:offset + len(value)] = value
    path.write_bytes(reseal(data))
    with pytest.raises(ConvertError, match=message):
        weights_file.read(path)


@pytest.mark.parametrize("change, message", [
    (lambda r: r[1].update(name="a"), "name is used twice"),
    (lambda r: r[0].update(shape=[3, 6]), "do not fit shape"),
    (lambda r: r[0].update(shape=[1 << 25, 0]), "do not fit shape"),
    (lambda r: r[1].update(offset=0), "overlaps"),
    (lambda r: r[1].update(offset=100), "overlaps another or ends outside"),
    (lambda r: r[3].update(offset=1 << 20), "ends outside"),
    (lambda r: r[2].update(dtype="I8"), "I8 without a scale"),
    (lambda r: r.pop(), "end with 64 zero"),
])
def test_reader_checks_records(path, tmp_path, tiny, monkeypatch, change, message):
    original = schema.to_flatbuffer

    def spoiled(metadata):
        change(metadata["tensors"])
        return original(metadata)
    monkeypatch.setattr(schema, "to_flatbuffer", spoiled)
    weights_file.write(path, [tiny], tensors(), PROVENANCE)
    with pytest.raises(ConvertError, match=message):
        weights_file.read(path)
