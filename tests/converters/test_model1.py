"""Model 1: which inputs reach what, and how tokens become values."""

import numpy as np
import pytest

from converters import networks, shapes
from converters.errors import ConvertError
from converters.goldens.model1 import CHANNELS, SMALL
from converters.random_weights import random_weights

torch = pytest.importorskip("torch")

from converters.reference import tokens  # noqa: E402  pylint: disable=wrong-import-position
from converters.reference.run import build, run  # noqa: E402  pylint: disable=wrong-import-position


def make(changes):
    network = networks.complete("model1", {"config": {**SMALL, **changes}})
    return network, build(network, random_weights(network, 1))


@pytest.mark.parametrize("code", ["Vector", "Sequence"])
def test_words_are_alone(code):
    network, module = make({"code": code})
    inputs = networks.random_inputs(network, 1)
    whole = run(module, inputs)
    for i in range(4):
        alone = run(module, {name: x[i:i + 1] for name, x in inputs.items()})
        for name, want in whole.items():
            np.testing.assert_array_equal(alone[name][0], want[i])


def test_f0_reaches_h_speech_only_and_text_h_text_only():
    network, module = make({})
    inputs, other = (networks.random_inputs(network, seed, words=1) for seed in (1, 2))
    base = run(module, inputs, taps=True)
    for name, reached, kept in (("f0", "h_speech", "h_text"), ("text", "h_text", "h_speech")):
        moved = run(module, {**inputs, name: other[name]}, taps=True)
        np.testing.assert_array_equal(moved["tap/" + kept], base["tap/" + kept])
        assert np.abs(moved["tap/" + reached] - base["tap/" + reached]).max() > 0.01
        assert np.abs(moved["tap/probabilities.0"] - base["tap/probabilities.0"]).max() > 1e-4


def test_probabilities_and_picks():
    network, module = make({})
    out = run(module, networks.random_inputs(network, 1, words=1), taps=True)
    for n, channel in enumerate(CHANNELS):
        p = out[f"tap/probabilities.{n}"]
        assert p.shape == (9, 3 + channel["levels"])
        np.testing.assert_allclose(p.sum(1), 1, atol=1e-6)
        np.testing.assert_array_equal(out["tokens"][0, :, n], p.argmax(1))
    assert out["tokens"].dtype == out["lengths"].dtype == np.int32


def test_tokens_stand_for_values():
    t = torch.tensor([[3, 3, 3], [4, 2, 8], [1, 5, 0], [2, 5, 5]])
    want = [[0, 0, -0.3], [0.5, 0, 0.2], [0, 0.5, 0], [0, 0.5, -0.1]]
    np.testing.assert_allclose(tokens.face_of(t, [{"minimum": 0.0, **c} for c in CHANNELS]), want)
    assert tokens.lengths_of(t).tolist() == [3, 1, 2]
    assert tokens.lengths_of(t[:1]).tolist() == [1, 1, 1]


def test_equal_scores_give_the_lowest_token():
    assert tokens.most_probable(torch.tensor([[0.0, 3, 1, 3], [2, 2, 2, 2]])).tolist() == [1, 0]


def test_full_size_shapes():
    wanted = shapes.network_shapes(networks.default_network("model1"))
    assert wanted["e1_speech.lstm1.weight_ih_l0_reverse"] == (800, 1)
    assert wanted["e_text.lstm1.weight_ih_l0"] == (800, 768)
    assert wanted["d_face.8.lstm1.weight_ih_l0"] == (400, 400)
    assert wanted["heads.0.weight"] == (503, 200)  # features.md, section 2.3
    # "50 lets a pre-trained D_face be used as it is": the width of AE_face's code.
    face = shapes.network_shapes(networks.default_network("autoencoder"))
    half = shapes.network_shapes(networks.complete("model1", {"config": {"hidden2": 50}}))
    for layer in ("lstm1", "lstm2"):
        for name in ("weight_ih_l0", "weight_hh_l0"):
            assert half[f"d_face.0.{layer}.{name}"] == face[f"decoder.{layer}.{name}"]


@pytest.mark.parametrize("config, message", [
    ({"channels": []}, "channels: none, expected at least one"),
    ({"channels": CHANNELS[:1] * 2}, "AU01.name: used twice"),
    ({"channels": [{**CHANNELS[0], "levels": 0}]}, "AU01.levels: 0, expected at least 1"),
    ({"channels": [{**CHANNELS[0], "step": -1}]}, "AU01.step: -1.0, expected above zero"),
    ({"hidden2": 0}, "hidden2: 0, expected at least 1"),
])
def test_configurations_that_are_refused(config, message):
    with pytest.raises(ConvertError, match=message):
        networks.complete("model1", {"config": {**SMALL, **config}})
