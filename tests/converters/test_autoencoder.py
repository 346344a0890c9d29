"""The autoencoders: Keras' layers, by hand."""

import numpy as np
import pytest

from converters import networks
from converters.goldens.autoencoder import SMALL, VALUES
from converters.random_weights import random_weights

pytest.importorskip("torch")

from converters.reference.run import build, run  # noqa: E402  pylint: disable=wrong-import-position


def make(changes, normalisations=()):
    network = networks.complete("autoencoder", {"config": {**SMALL, **changes},
                                                "normalisations": list(normalisations)})
    weights = random_weights(network, 1)
    return network, weights, build(network, weights)


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


def lstm_by_hand(weights, key, rows, reverse=False):
    """Gates i, f, g, o; a reversed layer reads from the end and answers in the order it reads."""
    end = "l0_reverse" if reverse else "l0"
    w_ih, w_hh, b_ih, b_hh = (weights[f"{key}.{name}_{end}"].astype(float)
                              for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh"))
    h = c = np.zeros(w_hh.shape[1])
    answers = []
    for x in rows[::-1] if reverse else rows:
        i, f, g, o = np.split(w_ih @ x + b_ih + w_hh @ h + b_hh, 4)
        c = sigmoid(f) * c + sigmoid(i) * np.tanh(g)
        h = sigmoid(o) * np.tanh(c)
        answers.append(h)
    return np.array(answers)


def leaky(x):
    return np.where(x > 0, x, 0.05 * x)


def test_the_code_is_keras_last_step():
    """Bidirectional(return_sequences=False): what each direction answers after its last row."""
    _, weights, module = make({})
    values = np.linspace(-2, 2, 9, dtype=np.float32)[None] ** 3
    rows = values[0].astype(float)[:, None]
    rows = leaky(np.concatenate([lstm_by_hand(weights, "encoder.lstm1", rows),
                                 lstm_by_hand(weights, "encoder.lstm1", rows, True)[::-1]], 1))
    want = leaky(np.concatenate([lstm_by_hand(weights, "encoder.lstm2", rows)[-1],
                                 lstm_by_hand(weights, "encoder.lstm2", rows, True)[-1]]))
    np.testing.assert_allclose(run(module, {"values": values})["code"][0], want, atol=1e-6)


def test_the_vector_stands_at_every_step():
    _, weights, module = make({"part": "Decoder"})
    code = np.linspace(-1, 1, 12, dtype=np.float32)[None]
    rows = np.repeat(code.astype(float), 9, 0)
    for layer in ("decoder.lstm1", "decoder.lstm2"):
        rows = leaky(lstm_by_hand(weights, layer, rows))
    want = rows @ weights["decoder.dense.weight"][0] + weights["decoder.dense.bias"][0]
    np.testing.assert_allclose(run(module, {"code": code})["reconstruction"][0], want, atol=1e-6)


@pytest.mark.parametrize("code", ["Vector", "Sequence"])
def test_both_halves_make_the_whole(code):
    network, weights, module = make({"code": code}, [VALUES])
    values = networks.random_inputs(network, 2, sequences=3)
    whole = run(module, values)
    parts = {}
    for part in ("Encoder", "Decoder"):
        half = networks.complete("autoencoder", {**network, "config": {**SMALL, "code": code,
                                                                       "part": part}})
        tensors = {key: x for key, x in weights.items() if key.startswith(part.lower())}
        parts |= run(build(half, tensors), parts or values)
    assert parts.keys() == whole.keys()
    for name, want in whole.items():
        np.testing.assert_allclose(parts[name], want, rtol=1e-6)
