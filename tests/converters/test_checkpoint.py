"""Reading what torch.save really writes."""

import collections

import numpy as np
import pytest

from converters.checkpoint import read_checkpoint
from converters.errors import ConvertError

torch = pytest.importorskip("torch")


def save(tmp_path, value, **options):
    path = tmp_path / "model.pt"
    torch.save(value, path, **options)
    return str(path)


def state_dict():
    torch.manual_seed(1)
    return torch.nn.Sequential(torch.nn.Linear(3, 4), torch.nn.LayerNorm(4)).state_dict()


@pytest.mark.parametrize("wrap", [
    lambda s: s,
    lambda s: {"state_dict": s, "epoch": 3, "best": 0.5, "name": "x"},
    lambda s: {"optimizer": {"state": {0: {"step": 1}}}, "model": s},
    lambda s: {"module." + key: value for key, value in s.items()},
    lambda s: {"state_dict": {"_orig_mod.module." + key: value for key, value in s.items()}},
], ids=["bare", "state_dict", "model", "data_parallel", "compiled"])
def test_finds_the_state_dict(tmp_path, wrap):
    want = state_dict()
    got = read_checkpoint(save(tmp_path, wrap(want))).tensors
    assert list(got) == list(want)
    for key, value in want.items():
        np.testing.assert_array_equal(got[key], value.numpy())


@pytest.mark.parametrize("dtype", ["float32", "float64", "float16", "bfloat16", "int64", "int32",
                                   "int16", "int8", "uint8", "bool"])
def test_reads_every_dtype(tmp_path, dtype):
    x = torch.tensor([[0, 1, 2], [3, 100, 7]]).to(getattr(torch, dtype))
    got = read_checkpoint(save(tmp_path, {"x": x})).tensors["x"]
    np.testing.assert_array_equal(got.astype(np.float64), x.to(torch.float64).numpy())


def test_reads_views_of_one_storage(tmp_path):
    base = torch.arange(24.0).reshape(4, 6)
    views = {"all": base, "transposed": base.t(), "column": base[:, 2], "inner": base[1:3, 2:5],
             "stepped": base[::2, ::3], "scalar": base[3, 5], "empty": base[:0]}
    got = read_checkpoint(save(tmp_path, views)).tensors
    for key, value in views.items():
        assert got[key].shape == tuple(value.shape)
        np.testing.assert_array_equal(got[key], value.numpy())


def test_reads_parameters_and_nested_lists(tmp_path):
    value = {"a": torch.nn.Parameter(torch.ones(2)), "b": [torch.zeros(1), {"c": torch.ones(3)}]}
    got = read_checkpoint(save(tmp_path, value)).tensors
    assert {key: x.shape for key, x in got.items()} == {"a": (2,), "b.0": (1,), "b.1.c": (3,)}


def test_keeps_the_order(tmp_path):
    want = collections.OrderedDict((f"k{i * 7 % 10}", torch.full((1,), i)) for i in range(10))
    assert list(read_checkpoint(save(tmp_path, want)).tensors) == list(want)


class Inner(torch.nn.Linear):
    """A class of the test's own, which no reader can know."""


@pytest.mark.parametrize("make, message", [
    (lambda p: torch.save(state_dict(), p, _use_new_zipfile_serialization=False), "before PyTorch"),
    (lambda p: torch.jit.script(torch.nn.Linear(2, 2)).save(str(p)), "TorchScript"),
    (lambda p: torch.save(Inner(2, 2), p), "Inner, expected tensors only"),
    (lambda p: torch.save({"epoch": 3}, p), "no tensors"),
    (lambda p: torch.save([torch.ones(1)], p), "holds a list"),
    (lambda p: torch.save({(1, 2): torch.ones(1)}, p), "a key is a tuple"),
    (lambda p: torch.save({"module.a": torch.ones(1), "b": {(3,): torch.ones(2)}}, p), "a key is"),
    (lambda p: torch.save({"x": torch.ones(1).expand(9)}, p), "does not fit its storage"),
    (lambda p: torch.save({"x": torch.ones(2, dtype=torch.complex64)}, p), "ComplexFloatStorage"),
    (lambda p: p.write_bytes(b"no archive at all"), "no checkpoint"),
    (lambda p: p.write_bytes(b""), "no checkpoint"),
], ids=["legacy", "torchscript", "whole_model", "no_tensors", "list", "tuple_key", "nested_key",
        "expanded", "complex", "foreign", "empty"])
def test_refuses(tmp_path, make, message):
    path = tmp_path / "model.pt"
    make(path)
    with pytest.raises(ConvertError, match=message) as caught:
        read_checkpoint(str(path))
    assert "\n" not in str(caught.value)


def test_every_truncation_is_refused(tmp_path):
    path = tmp_path / "model.pt"
    torch.save({"x": torch.arange(5.0)}, path)
    data = path.read_bytes()
    for length in range(len(data)):
        path.write_bytes(data[:length])
        with pytest.raises(ConvertError):
            read_checkpoint(str(path))
