"""bf16 and int8 tensors: their rounding, and their place in weights files."""

import struct

import numpy as np
import pytest

from converters import goldens, weights_file
from converters.__main__ import main
from converters.errors import ConvertError
from converters.goldens import ast
from converters.quantised import Quantised, to_bf16, to_int8

from test_weights_file import PROVENANCE, reseal


def test_bf16_is_the_nearest():
    """Of all neighbours, those of ties with an even last bit."""
    x = np.random.default_rng(1).standard_normal(10000).astype(np.float32)
    x[:4] = [1 + 2 ** -8, 1 + 3 * 2 ** -8, -(1 + 2 ** -8), 0]
    got = to_bf16(x).float32()
    assert list(got[:4]) == [1, 1 + 2 ** -6, -1, 0]
    neighbours = [((x.view(np.uint32) & 0xffff0000) + step).view(np.float32)
                  for step in (np.uint32(0), np.uint32(0x10000))]
    best = np.minimum(*(np.abs(n.astype(np.float64) - x) for n in neighbours))
    np.testing.assert_array_equal(np.abs(got.astype(np.float64) - x), best)


def test_bf16_of_the_largest_stays_finite():
    x = np.array([np.finfo(np.float32).max, -np.finfo(np.float32).max], np.float32)
    assert np.isfinite(to_bf16(x).float32()).all()


@pytest.mark.parametrize("shape", [(3, 5), (4, 2, 3), (2, 1, 4, 4)])
def test_int8_is_within_half_a_step(shape):
    x = np.random.default_rng(2).standard_normal(shape).astype(np.float32)
    x[0] = 0
    q = to_int8(x)
    assert q.values.min() >= -127 and (np.abs(q.values[1:].reshape(shape[0] - 1, -1)).max(1)
                                       == 127).all()
    assert q.scale.shape == shape[:1] and q.scale[0] == 1
    steps = q.scale.reshape(-1, *(1,) * (len(shape) - 1))
    assert (np.abs(q.float32() - x) <= steps * 0.5001).all()


@pytest.fixture
def tensors():
    x = np.random.default_rng(3).standard_normal((6, 10)).astype(np.float32)
    return {"a": to_int8(x), "b": to_bf16(x[:3]), "c": x}


@pytest.fixture
def path(tmp_path, tiny, tensors):
    target = tmp_path / "x.fb"
    weights_file.write(target, [tiny], tensors, PROVENANCE)
    return target


def test_round_trip(path, tensors):
    got = weights_file.read(path).tensors
    assert list(got) == ["a", "b", "c"]
    assert [record["name"] for record in weights_file.read(path).metadata["tensors"]] == [
        "a", "a.scale", "b", "c"]
    for name in "ab":
        np.testing.assert_array_equal(got[name].values, tensors[name].values)
        np.testing.assert_array_equal(got[name].float32(), tensors[name].float32())
    np.testing.assert_array_equal(got["a"].scale, tensors["a"].scale)


@pytest.mark.parametrize("tensor, message", [
    (Quantised("I8", np.zeros(4, np.int8), np.ones(4, np.float32)), "fewer than two dimensions"),
    (Quantised("I8", np.full((2, 2), -128, np.int8), np.ones(2, np.float32)), "holds -128"),
    (Quantised("I8", np.zeros((2, 2), np.int8), np.ones(3, np.float32)), "expected (2,) float32"),
    (Quantised("I8", np.zeros((2, 2), np.int8), np.array([1, 0], np.float32)), "above zero"),
    (Quantised("I8", np.zeros((2, 2), np.int8), np.array([1, np.inf], np.float32)), "above zero"),
    (Quantised("I8", np.zeros((1, 65537), np.int8), np.ones(1, np.float32)), "at most 65536"),
    (Quantised("BF16", np.array([0x7f80], np.uint16)), "NaN or infinity"),
])
def test_writer_refuses(tmp_path, tiny, tensor, message):
    import re
    with pytest.raises(ConvertError, match=re.escape(message)):
        weights_file.write(tmp_path / "x.fb", [tiny], {"x": tensor}, PROVENANCE)


def test_writer_refuses_the_name_of_scales_taken(tmp_path, tiny, tensors):
    with pytest.raises(ConvertError, match="name of the scales of a"):
        weights_file.write(tmp_path / "x.fb", [tiny],
                           tensors | {"a.scale": np.ones(6, np.float32)}, PROVENANCE)


def test_reader_refuses_changed_payloads(path, tensors):
    data = bytearray(path.read_bytes())
    begin = data.index(tensors["a"].values.tobytes())
    for at, byte, message in ((begin, b"\x80", "holds -128"),
                              (data.index(tensors["a"].scale.tobytes()),
                               struct.pack("<f", -1), "above zero"),
                              (data.index(tensors["b"].values.tobytes()), b"\x80\x7f", "NaN")):
        changed = bytearray(data)
        changed[at:at + len(byte)] = byte
        path.write_bytes(reseal(changed))
        with pytest.raises(ConvertError, match=message):
            weights_file.read(path)


def test_reader_refuses_a_scale_of_no_tensor(path):
    # The name of the scale's tensor, wherever it is said.
    data = path.read_bytes()
    first = data.index(b"a.scale")
    second = data.index(b"a.scale", first + 1)
    for at in (first, second):
        changed = data[:at] + b"x" + data[at + 1:]
        path.write_bytes(reseal(changed))
        with pytest.raises(ConvertError, match="no such tensor"):
            weights_file.read(path)


def test_quantise_needs_infer_cli(tmp_path, capfd):
    pytest.importorskip("torch")
    goldens.make_case(str(tmp_path), ast.CASES[0])
    source = str(tmp_path / f"{ast.CASES[0].name}.fb")
    assert main(["quantise", source, "--to", "int8", "-o", str(tmp_path / "y.fb"), "--infer-cli",
                 "/nowhere/infer-cli"]) == 2
    assert "/nowhere/infer-cli" in capfd.readouterr().err
    assert not (tmp_path / "y.fb").exists()
