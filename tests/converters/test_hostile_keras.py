"""HDF5 files made to do harm: refused with a sentence; nothing outside the file is read, nothing in
it is run."""

import base64
import json
import marshal
import os
import random

import numpy as np
import pytest

h5py = pytest.importorskip("h5py")

import keras_file as keras  # noqa: E402  pylint: disable=wrong-import-position
from converters import isolate  # noqa: E402
from converters.checkpoint import read_checkpoint  # noqa: E402
from converters.errors import ConvertError  # noqa: E402

KERNEL, BIAS = np.ones((3, 2), np.float32), np.zeros(2, np.float32)
LAYERS = [keras.dense("dense", KERNEL, BIAS)]
PLACE = "model_weights/dense/dense"


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "model.h5"
    keras.write_model(path, LAYERS)
    return path


@pytest.fixture
def other(tmp_path):
    """A file of somebody else's, with numbers that must not come out."""
    path = tmp_path / "secret.h5"
    keras.write_model(path, LAYERS)
    return path


def replace(file, name="kernel:0"):
    del file[PLACE][name]
    return file[PLACE]


def external_link(file, other):
    replace(file)["kernel:0"] = h5py.ExternalLink(str(other), PLACE + "/kernel:0")


def external_group(file, other):
    del file["model_weights/dense"]
    file["model_weights"]["dense"] = h5py.ExternalLink(str(other), "model_weights/dense")


def external_root(file, other):
    del file["model_weights"]
    file["model_weights"] = h5py.ExternalLink(str(other), "model_weights")


def soft_link(file, _):
    replace(file)["kernel:0"] = h5py.SoftLink(f"/{PLACE}/bias:0")


def dangling_link(file, _):
    replace(file)["kernel:0"] = h5py.SoftLink("/nowhere")


def soft_group(file, _):
    del file["model_weights/dense/dense"]
    file["model_weights/dense"]["dense"] = h5py.SoftLink("/")


def virtual(file, other):
    layout = h5py.VirtualLayout(shape=KERNEL.shape, dtype="f4")
    layout[:] = h5py.VirtualSource(str(other), PLACE + "/kernel:0", shape=KERNEL.shape)
    replace(file).create_virtual_dataset("kernel:0", layout)


def raw_storage(file, other):
    replace(file).create_dataset("kernel:0", shape=KERNEL.shape, dtype="f4",
                                 external=[(str(other), 0, KERNEL.nbytes)])


def huge(file, _):
    replace(file).create_dataset("kernel:0", shape=(1 << 20, 1 << 20), dtype="f4")


def huge_chunked(file, _):
    replace(file).create_dataset("kernel:0", shape=(1 << 20, 1 << 20), dtype="f4", chunks=(64, 64))


def huge_chunk(file, _):
    replace(file).create_dataset("kernel:0", shape=(3, 2), maxshape=(None, None), dtype="f4",
                                 chunks=(1 << 14, 1 << 14), data=KERNEL, compression="gzip")


def bomb(file, _):
    replace(file).create_dataset("kernel:0", data=np.zeros((1 << 11, 1 << 11), np.float32),
                                 compression="gzip", chunks=(1 << 10, 1 << 10))


def bombs_together(file, _):
    """None of them is over the limit alone."""
    names = []
    for n in range(40):
        keras.write_names(file["model_weights"].create_group(f"d{n}"), "weight_names", ["x"])
        file[f"model_weights/d{n}"].create_dataset("x", data=np.zeros(1 << 15, np.float32),
                                                   compression="gzip")
        names.append(f"d{n}")
    keras.write_names(file["model_weights"], "layer_names", names)


def own_filter(file, _):
    replace(file).create_dataset("kernel:0", data=KERNEL, compression="lzf", chunks=(3, 2))


def objects(file, _):
    made = replace(file).create_dataset("kernel:0", (2,), dtype=h5py.special_dtype(vlen=str))
    made[:] = ["a", "b"]


def lists(file, _):
    made = replace(file).create_dataset("kernel:0", (1,), dtype=h5py.vlen_dtype(np.float32))
    made[0] = np.ones(3, np.float32)


def references(file, _):
    made = replace(file).create_dataset("kernel:0", (1,), dtype=h5py.ref_dtype)
    made[0] = file["model_weights"].ref


def opaque(file, _):
    made = np.array([b"x"], "V8").astype(h5py.opaque_dtype("V8"))
    replace(file).create_dataset("kernel:0", data=made)


def compound(file, _):
    replace(file).create_dataset("kernel:0", data=np.zeros(2, "f4,f4"))


def complex_numbers(file, _):
    replace(file).create_dataset("kernel:0", data=np.zeros(2, "c8"))


def null_space(file, _):
    replace(file).create_dataset("kernel:0", data=h5py.Empty("f4"))


def group_for_data(file, _):
    replace(file).create_group("kernel:0")


def data_for_group(file, _):
    del file["model_weights/dense"]
    file["model_weights"].create_dataset("dense", data=KERNEL)


def named_type(file, _):
    replace(file)["kernel:0"] = np.dtype("f4")


def missing(file, _):
    replace(file)


def names_numbers(file, _):
    file["model_weights/dense"].attrs["weight_names"] = np.arange(3)


def names_references(file, _):
    del file["model_weights/dense"].attrs["weight_names"]
    file["model_weights/dense"].attrs.create("weight_names", [file.ref], dtype=h5py.ref_dtype)


def names_missing(file, _):
    del file["model_weights/dense"].attrs["weight_names"]


def names_no_text(file, _):
    file["model_weights/dense"].attrs["weight_names"] = np.array([b"\xff\xfe"])


def names_upwards(file, _):
    keras.write_names(file["model_weights/dense"], "weight_names", ["../dense/dense/kernel:0"])


def names_absolute(file, _):
    keras.write_names(file["model_weights/dense"], "weight_names", [f"/{PLACE}/kernel:0"])


def names_escape(file, _):
    keras.write_names(file["model_weights/dense"], "weight_names", ["\x1b[31m"])


def names_twice(file, _):
    keras.write_names(file["model_weights/dense"], "weight_names", ["dense/kernel:0"] * 2)


def names_many(file, other):
    """HDF5's latest version takes attributes of any size."""
    with h5py.File(other, "w", libver="latest") as made:
        group = made.create_group("model_weights")
        group.attrs["layer_names"] = np.full((1 << 16) + 1, b"x")
        file.copy(group, file["/"], "copy")
    del file["model_weights"]
    file.move("copy", "model_weights")


HOSTILE = {
    external_link: "an external link", external_group: "dense: an external link",
    external_root: "model_weights: an external link", soft_link: "a soft link",
    dangling_link: "a soft link", soft_group: "a soft link", virtual: "stand in other files",
    raw_storage: "stand in other files", huge: "0 bytes for shape", huge_chunked: "more than a file",
    huge_chunk: "more than a file", bomb: "more than a file", bombs_together: "more than a file",
    own_filter: "filters other than", objects: "expected numbers", lists: "expected numbers",
    references: "expected numbers", opaque: "expected numbers", compound: "expected numbers",
    complex_numbers: "expected numbers", null_space: "expected at most", missing: "missing",
    group_for_data: "a Group, expected a Dataset", data_for_group: "a Dataset, expected a Group",
    named_type: "a Datatype, expected a Dataset", names_numbers: "expected text",
    names_references: "expected text", names_missing: "weight_names is missing",
    names_no_text: "damaged: UnicodeDecodeError", names_upwards: "missing",
    names_absolute: "missing", names_many: "more than Keras writes", names_escape: "missing", names_twice: "is there twice",
}


@pytest.mark.parametrize("change", HOSTILE, ids=lambda change: change.__name__)
def test_hostile(model, other, change):
    with h5py.File(model, "a", libver="latest") as file:
        change(file, other)
    with pytest.raises(ConvertError, match=HOSTILE[change]) as caught:
        read_checkpoint(str(model))
    assert "\n" not in str(caught.value)


def described(model, change):
    with h5py.File(model, "a") as file:
        config = json.loads(file.attrs["model_config"])
        change(config["config"]["layers"])
        file.attrs["model_config"] = json.dumps(config)


CONFIGS = {
    "text": ('"Functional"', "no model of layers"),
    "list": ("[]", "no model of layers"),
    "no_json": ("{", "no JSON"),
    "deep": ("[" * 100_000, "nested too deeply"),
    "deep_models": ('{"class_name": "F", "config": {"name": "a", "layers": [' * 200 + "]}}" * 200,
                    "nested too deeply"),
    "key_twice": ('{"config": 1, "config": 2}', "there twice"),
    "no_class": ('{"config": {"layers": [{"config": {"name": "a"}}]}}', "without class_name"),
    "no_name": ('{"config": {"layers": [{"class_name": "A", "config": {}}]}}', "without a name"),
    "name_is_list": ('{"config": {"layers": [{"class_name": "A", "config": {"name": []}}]}}',
                     "without a name"),
    "no_inner": ('{"config": {"layers": [{"class_name": "TimeDistributed", '
                 '"config": {"name": "a"}}]}}', "without class_name"),
}


@pytest.mark.parametrize("name", CONFIGS)
def test_hostile_model_config(model, name):
    text, message = CONFIGS[name]
    with h5py.File(model, "a") as file:
        file.attrs["model_config"] = text
    with pytest.raises(ConvertError, match=message):
        read_checkpoint(str(model))


def test_epsilon_that_is_no_number(model):
    keras.write_model(model, [keras.layer("LayerNormalization", "n", {"gamma": BIAS},
                                          epsilon="tiny")])
    with pytest.raises(ConvertError, match="layer n: epsilon tiny, expected a number"):
        read_checkpoint(str(model))


def test_lambda_layers_do_not_run(tmp_path, model):
    sentinel = tmp_path / "sentinel"
    code = compile(f"open({str(sentinel)!r}, 'w')", "x", "eval")
    packed = base64.b64encode(marshal.dumps(code)).decode()
    keras.write_model(model, [
        keras.layer("Lambda", "lambda", function=[packed, None, None], function_type="lambda",
                    module="os", output_shape=packed, output_shape_type="lambda"), *LAYERS])
    found = read_checkpoint(str(model))
    assert found.layers[0] == "lambda: Lambda, its code is not read"
    assert list(found.tensors) == ["dense.weight", "dense.bias"] and not sentinel.exists()


def test_pickles_in_attributes_do_not_run(tmp_path, model):
    import pickle

    class Program:
        def __reduce__(self):
            return os.system, (f"touch {tmp_path / 'sentinel'}",)

    with h5py.File(model, "a") as file:
        for group in (file, file["model_weights"], file["model_weights/dense"]):
            group.attrs["training_config"] = np.void(pickle.dumps(Program()))
            group.attrs["object"] = np.void(pickle.dumps(Program(), 0))
        file["model_weights/dense/dense/kernel:0"].attrs["CLASS"] = np.void(
            pickle.dumps(Program()))
    assert len(read_checkpoint(str(model)).tensors) == 2
    assert not (tmp_path / "sentinel").exists()


def test_groups_in_a_circle(model):
    with h5py.File(model, "a") as file:
        file["model_weights/dense/dense/dense"] = file["model_weights/dense"]
        keras.write_names(file["model_weights/dense"], "weight_names",
                          ["dense/" * 2 + "dense/kernel:0"])
    assert list(read_checkpoint(str(model)).tensors) == ["dense.dense.dense.weight",
                                                        "dense.dense.dense.bias"]


def test_damaged_bytes(model, tmp_path):
    """Seeded damage: refused in a sentence, or arrays within the limit; HDF5 may fall over, this
    process may not."""
    good = model.read_bytes()
    source = random.Random(20231)
    path = tmp_path / "damaged.h5"
    for n in range(150):
        data = bytearray(good)
        for _ in range(1 if n % 2 else 8):
            data[source.randrange(8, len(data))] = source.randrange(256)
        path.write_bytes(data if n % 5 else data[:source.randrange(8, len(data))])
        try:
            tensors = read_checkpoint(str(path)).tensors
        except ConvertError:
            continue
        assert sum(x.nbytes for x in tensors.values()) <= 16 * len(good)


def crash(_):
    os.abort()


def spin(_):
    while True:
        pass


def hoard(_):
    return None, [np.ones(1 << 27)]


def leave(_):
    raise RuntimeError


@pytest.mark.parametrize("parser, message", [
    (crash, "ended with Aborted"), (spin, "ended with CPU time limit"),
    (hoard, "ended with exit code 1"), (leave, "ended with exit code 1")])
def test_a_parser_that_ends_is_a_sentence(parser, message):
    with pytest.raises(ConvertError, match=message):
        isolate.arrays_of(parser, "x.h5", 64 << 20, 1)
