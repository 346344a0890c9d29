"""Keras' layers: what Keras computes, written in NumPy after its documentation, is what PyTorch
computes with the converted arrays."""

import numpy as np
import pytest

pytest.importorskip("h5py")
torch = pytest.importorskip("torch")

import keras_file as keras  # noqa: E402  pylint: disable=wrong-import-position
from converters.checkpoint import KERAS, read_checkpoint  # noqa: E402
from converters.errors import ConvertError  # noqa: E402


def numbers(seed, *shape):
    return (0.5 * np.random.default_rng(seed).standard_normal(shape)).astype(np.float32)


def random_lstm(name, columns, units, seed=1, bias=True, **config):
    return keras.lstm(name, numbers(seed, columns, 4 * units), numbers(seed + 1, units, 4 * units),
                      numbers(seed + 2, 4 * units) if bias else None, **config)


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


def keras_lstm(layer, x, backwards=False):
    """Keras' formulas: z = x W + h U + b in gates i, f, c, o; rows (T, columns) -> (T, units)."""
    kernel, recurrent, *bias = (a.astype(np.float64) for a in layer[2].values())
    units = recurrent.shape[0]
    h = c = np.zeros(units)
    rows = []
    for row in x[::-1] if backwards else x:
        z = row @ kernel + h @ recurrent + (bias[0] if bias else 0)
        i, f, g, o = (z[n * units:(n + 1) * units] for n in range(4))
        c = sigmoid(f) * c + sigmoid(i) * np.tanh(g)
        h = sigmoid(o) * np.tanh(c)
        rows.append(h)
    return np.array(rows[::-1] if backwards else rows)


def keras_conv1d(kernel, bias, x):
    """padding "same": (T, in) -> (T, out)."""
    size = kernel.shape[0]
    left = (size - 1) // 2
    x = np.pad(x, ((left, size - 1 - left), (0, 0)))
    return np.array([np.tensordot(x[t:t + size], kernel, 2) + bias
                     for t in range(len(x) - size + 1)])


def run(module, tensors, prefix, x):
    state = {key[len(prefix):]: torch.tensor(np.array(value)).double()
             for key, value in tensors.items() if key.startswith(prefix)}
    module.double().load_state_dict(state)
    with torch.no_grad():
        y = module(torch.tensor(x.astype(np.float64)))
    return (y[0] if isinstance(y, tuple) else y).numpy()


@pytest.fixture
def read(tmp_path):
    def read(layers, write=keras.write_model, **options):
        path = tmp_path / "model.weights"  # known by its content
        write(path, layers, **options)
        return read_checkpoint(str(path))
    return read


BOTH = pytest.mark.parametrize("write", [keras.write_model, keras.write_weights])


@BOTH
@pytest.mark.parametrize("bias", [True, False])
def test_lstm(read, write, bias):
    layer, x = random_lstm("lstm_3", 5, 4, bias=bias), numbers(9, 7, 5)
    found = read([keras.layer("InputLayer", "input_1"), layer], write)
    assert found.format == KERAS
    want = keras_lstm(layer, x)
    got = run(torch.nn.LSTM(5, 4), found.tensors, "lstm_3.", x)
    np.testing.assert_allclose(got, want, atol=1e-12)
    assert found.implied == {"lstm_3.bias_hh_l0"} | (set() if bias else {"lstm_3.bias_ih_l0"})


@BOTH
def test_bidirectional(read, write):
    forward, backward = random_lstm("lstm", 3, 4), random_lstm("lstm", 3, 4, seed=5)
    found = read([keras.bidirectional("bidirectional_1", forward, backward)], write)
    x = numbers(9, 6, 3)
    want = np.concatenate([keras_lstm(forward, x), keras_lstm(backward, x, True)], 1)
    module = torch.nn.LSTM(3, 4, bidirectional=True)
    got = run(module, found.tensors, "bidirectional_1.", x)
    np.testing.assert_allclose(got, want, atol=1e-12)


@BOTH
@pytest.mark.parametrize("size", [1, 3, 5])
def test_conv1d(read, write, size):
    kernel, bias, x = numbers(1, size, 4, 6), numbers(2, 6), numbers(3, 9, 4)
    found = read([keras.conv1d("conv1d", kernel, bias)], write)
    module = torch.nn.Conv1d(4, 6, size, padding="same")
    got = run(module, found.tensors, "conv1d.", x.T[None])[0].T
    np.testing.assert_allclose(got, keras_conv1d(kernel, bias, x.astype(float)), atol=1e-6)


@BOTH
@pytest.mark.parametrize("bias", [True, False])
def test_dense(read, write, bias):
    kernel, b, x = numbers(1, 4, 6), numbers(2, 6), numbers(3, 9, 4)
    found = read([keras.dense("dense_2", kernel, b if bias else None)], write)
    got = run(torch.nn.Linear(4, 6), found.tensors, "dense_2.", x)
    np.testing.assert_allclose(got, x.astype(float) @ kernel + (b if bias else 0), atol=1e-6)


@BOTH
def test_embedding_and_layer_normalization(read, write):
    table, gamma, beta = numbers(1, 10, 4), numbers(2, 4), numbers(3, 4)
    found = read([
        keras.layer("Embedding", "embedding", {"embeddings": table}, input_dim=10, output_dim=4),
        keras.layer("LayerNormalization", "norm", {"gamma": gamma, "beta": beta}, epsilon=1e-6),
        keras.layer("LayerNormalization", "norm_1", {"beta": beta}, scale=False)], write)
    t = found.tensors
    np.testing.assert_array_equal(t["embedding.weight"], table)
    np.testing.assert_array_equal(t["norm.weight"], gamma)
    np.testing.assert_array_equal(t["norm.bias"], beta)
    np.testing.assert_array_equal(t["norm_1.weight"], np.ones(4))
    assert found.epsilons == ({"norm": 1e-6, "norm_1": 1e-3} if write is keras.write_model else {})


@BOTH
def test_multi_head_attention(read, write):
    """Keras: (columns, heads, width) in, (heads, width, columns) out; against PyTorch's."""
    heads, width, d, x = 2, 3, 6, numbers(9, 5, 6)
    variables = {f"{name}/{part}": numbers(n, *shape)
                 for n, name in enumerate(("query", "key", "value"))
                 for part, shape in (("kernel", (d, heads, width)), ("bias", (heads, width)))}
    variables |= {"attention_output/kernel": numbers(7, heads, width, d),
                  "attention_output/bias": numbers(8, d)}
    t = read([keras.layer("MultiHeadAttention", "mha", variables, num_heads=heads,
                          key_dim=width)], write).tensors
    q, k, v = (np.einsum("ti,ihw->thw", x, variables[n + "/kernel"]) + variables[n + "/bias"]
               for n in ("query", "key", "value"))
    scores = np.einsum("thw,shw->hts", q, k) / np.sqrt(width)
    weights = np.exp(scores) / np.exp(scores).sum(-1, keepdims=True)
    want = np.einsum("hts,shw,hwo->to", weights, v, variables["attention_output/kernel"])
    module = torch.nn.MultiheadAttention(d, heads)
    parts = ["query", "key", "value"]
    module.load_state_dict({name: torch.tensor(np.array(value)) for name, value in {
        "in_proj_weight": np.concatenate([t[f"mha.{n}.weight"] for n in parts]),
        "in_proj_bias": np.concatenate([t[f"mha.{n}.bias"] for n in parts]),
        "out_proj.weight": t["mha.attention_output.weight"],
        "out_proj.bias": t["mha.attention_output.bias"]}.items()})
    with torch.no_grad():
        rows = torch.tensor(x)
        got = module(rows, rows, rows)[0].numpy()
    np.testing.assert_allclose(got, want + variables["attention_output/bias"], atol=1e-5)


def test_time_distributed_and_nested_models(read):
    inner = keras.bidirectional("bidirectional", random_lstm("lstm", 3, 4), random_lstm("lstm", 3,
                                                                                        4, 5))
    kernel, bias = numbers(1, 8, 2), numbers(2, 2)
    encoder = keras.nested("encoder", [keras.layer("InputLayer", "input_1"), inner])
    found = read([keras.layer("InputLayer", "input_2"), encoder,
                  keras.time_distributed("time_distributed", keras.dense("dense", kernel, bias)),
                  keras.nested("heads", [keras.nested("inner", [keras.dense("dense_1", kernel,
                                                                            bias)], "Sequential")])])
    assert list(found.tensors) == [
        *[f"encoder.bidirectional.{name}_l0{suffix}" for suffix in ("", "_reverse")
          for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh")],
        "time_distributed.weight", "time_distributed.bias", "heads.dense_1.weight",
        "heads.dense_1.bias"]
    np.testing.assert_array_equal(found.tensors["time_distributed.weight"], kernel.T)
    assert found.layers == [
        "input_2: InputLayer", "encoder.input_1: InputLayer",
        "encoder.bidirectional: Bidirectional of LSTM, units 4, activation tanh, "
        "recurrent_activation sigmoid, return_sequences True, go_backwards False, use_bias True, "
        "gate order i f c o, merge_mode concat",
        "time_distributed: TimeDistributed of Dense, units 2, activation linear, use_bias True",
        "heads.inner.dense_1: Dense, units 2, activation linear, use_bias True"]


def test_names_of_other_versions(read):
    """Without the cell (2.0), without ":0" and after the model's name (Keras 3)."""
    _, config, variables = random_lstm("lstm", 3, 4)
    arrays = list(variables.values())
    for names in (["lstm/kernel:0", "lstm/recurrent_kernel:0", "lstm/bias:0"],
                  ["sequential/lstm/lstm_cell/" + n for n in ("kernel", "recurrent_kernel",
                                                              "bias")]):
        found = read([("LSTM", config, dict(zip(names, arrays)))])
        assert list(found.tensors) == ["lstm." + n + "_l0" for n in ("weight_ih", "weight_hh",
                                                                     "bias_ih", "bias_hh")]


def test_chunks_and_compression(read):
    found = read([keras.dense("dense", numbers(1, 40, 30), numbers(2, 30))], compression="gzip",
                 shuffle=True, fletcher32=True)
    np.testing.assert_array_equal(found.tensors["dense.weight"], numbers(1, 40, 30).T)


def test_many_layers_in_several_attributes(read):
    layers = [keras.layer("ReLU", f"re_lu_{'x' * 200}_{n}") for n in range(400)]
    found = read([*layers, keras.dense("dense", numbers(1, 3, 2), numbers(2, 2))])
    assert list(found.tensors) == ["dense.weight", "dense.bias"] and len(found.layers) == 401


def bi(**config):
    return keras.bidirectional("x", random_lstm("lstm", 3, 4), random_lstm("lstm", 3, 4, 5),
                               **config)


UNSUPPORTED = {
    "backwards": (random_lstm("x", 3, 4, go_backwards=True), "LSTM with go_backwards True"),
    "relu": (random_lstm("x", 3, 4, activation="relu"), "LSTM with activation relu"),
    "custom_activation": (random_lstm("x", 3, 4, activation={"class_name": "f"}),
                          "LSTM with activation {"),
    "hard_sigmoid": (random_lstm("x", 3, 4, recurrent_activation="hard_sigmoid"),
                     "recurrent_activation hard_sigmoid, expected sigmoid"),
    "merge_sum": (bi(merge_mode="sum"), "merge_mode sum, expected concat"),
    "merge_none": (bi(merge_mode=None), "merge_mode None"),
    "inner_relu": (bi(layer={"class_name": "LSTM", "config": {"name": "l", "activation": "relu"}}),
                   "forward LSTM with activation relu"),
    "inner_gru": (bi(layer={"class_name": "GRU", "config": {"name": "l"}}), "class GRU"),
    "backward_gru": (bi(backward_layer={"class_name": "GRU", "config": {}}), "that is no LSTM"),
    "backward_forward": (bi(backward_layer={"class_name": "LSTM", "config": {}}),
                         "backward LSTM with go_backwards False"),
    "gru": (keras.layer("GRU", "x", {"gru_cell/kernel": numbers(1, 3, 12),
                                     "gru_cell/recurrent_kernel": numbers(2, 4, 12),
                                     "gru_cell/bias": numbers(3, 2, 12)}), "class GRU"),
    "batch_norm": (keras.layer("BatchNormalization", "x", {
        n: numbers(1, 4) for n in ("gamma", "beta", "moving_mean", "moving_variance")}),
        "class BatchNormalization, expected LSTM, Dense"),
    "strides": (keras.conv1d("x", numbers(1, 3, 4, 5), None, strides=[2]), "Conv1D with strides 2"),
    "causal": (keras.conv1d("x", numbers(1, 3, 4, 5), None, padding="causal"), "padding causal"),
    "channels_first": (keras.conv1d("x", numbers(1, 3, 4, 5), None, data_format="channels_first"),
                       "data_format channels_first"),
    "conv_transpose": (keras.layer("Conv1DTranspose", "x", {"kernel": numbers(1, 3, 4, 5)}),
                       "class Conv1DTranspose"),
    "dense_with_more": (keras.layer("Dense", "x", {"kernel": numbers(1, 3, 4),
                                                   "gain": numbers(2, 4)}), "variable gain"),
}


@pytest.mark.parametrize("name", UNSUPPORTED)
def test_unsupported_layers_have_no_tensors_but_a_reason(read, name):
    layer, reason = UNSUPPORTED[name]
    found = read([layer, keras.dense("dense", numbers(1, 3, 2), numbers(2, 2))])
    assert list(found.tensors) == ["dense.weight", "dense.bias"]
    (key, why), = found.refused.items()
    assert key == "x" and reason in why


def test_weights_without_model_config_are_told_by_their_variables(read):
    gru = keras.layer("GRU", "gru", {"kernel": numbers(1, 3, 12), "bias": numbers(3, 2, 12),
                                     "recurrent_kernel": numbers(2, 4, 12)})
    found = read([gru, random_lstm("lstm", 3, 4), keras.layer("Own", "own", {
        "positions": numbers(1, 2, 3)})], keras.write_weights)
    assert "an LSTM's four gates" in found.refused["gru"] and "lstm.weight_ih_l0" in found.tensors
    assert found.tensors["own.positions"].shape == (2, 3)
    assert found.layers[1:] == ["lstm: LSTM", "own: class of its own"]
    assert "not checked" in found.notes[0]


def test_old_sequential_model(tmp_path):
    import h5py
    import json
    path = tmp_path / "m.h5"
    keras.write_model(path, [keras.dense("dense", numbers(1, 3, 2), None, activation="relu")])
    with h5py.File(path, "a") as file:
        config = json.loads(file.attrs["model_config"])
        file.attrs["model_config"] = json.dumps({"class_name": "Sequential",
                                                 "config": config["config"]["layers"]})
    assert read_checkpoint(str(path)).layers == [
        "dense: Dense, units 2, activation relu, use_bias False"]


def test_keras_3_weights_are_refused_by_name(tmp_path):
    import h5py
    with h5py.File(tmp_path / "m.weights.h5", "w") as file:
        file.create_dataset("layers/dense/vars/0", data=numbers(1, 3, 2))
    with pytest.raises(ConvertError, match="Keras 3's save_weights"):
        read_checkpoint(str(tmp_path / "m.weights.h5"))
