"""BERT: what padding, chunks and the classifier may and may not change."""

import numpy as np
import pytest

from converters import networks, shapes
from converters.errors import ConvertError
from converters.goldens.bert import DISTIL, SMALL, VOCABULARY
from converters.kinds.bert import DIALOG_ACTS
from converters.random_weights import random_weights

pytest.importorskip("torch")

from converters.reference.run import build, run  # noqa: E402  pylint: disable=wrong-import-position


def make(config):
    network = networks.complete("bert", {"config": config})
    return build(network, random_weights(network, 1))


def test_padding_changes_nothing_and_is_zero():
    module = make(SMALL)
    ids = np.array([[5, 17, 90]], np.int32)
    short = run(module, {"ids": ids})["hidden"]
    long = run(module, {"ids": np.pad(ids, ((0, 1), (0, 4)))})["hidden"]
    np.testing.assert_array_equal(long[0, :3], short[0])
    assert not long[0, 3:].any() and not long[1].any()


def test_chunks_know_nothing_of_each_other():
    module = make(SMALL)
    ids = np.arange(3, 28, dtype=np.int32)[None]
    whole = run(module, {"ids": ids})["hidden"][0]
    for begin in (0, 10, 20):
        part = run(module, {"ids": ids[:, begin:begin + 10]})["hidden"][0]
        np.testing.assert_array_equal(whole[begin:begin + 10], part)


def test_special_pieces_come_from_the_vocabulary():
    """[CLS] is the last line of VOCABULARY and [SEP] the third."""
    network = networks.complete("bert", {"config": {**SMALL, "tokens": 20}})
    module = build(network, random_weights(network, 1) | {"vocabulary": VOCABULARY})
    ids = np.array([[4]], np.int32)
    taps = run(module, {"ids": ids}, taps=True)
    weights = {key: x.astype(float) for key, x in random_weights(network, 1).items()}
    x = (weights["embeddings.word_embeddings.weight"][[19, 4, 2]]
         + weights["embeddings.position_embeddings.weight"][:3]
         + weights["embeddings.token_type_embeddings.weight"][0])
    x = (x - x.mean(1, keepdims=True)) / np.sqrt(x.var(1, keepdims=True) + 1e-12)
    want = x * weights["embeddings.LayerNorm.weight"] + weights["embeddings.LayerNorm.bias"]
    np.testing.assert_allclose(taps["tap/embeddings/out"], want, atol=1e-6)


def test_acts_are_the_most_probable():
    out = run(make(DISTIL), {"ids": np.arange(1, 25, dtype=np.int32).reshape(6, 4)})
    np.testing.assert_allclose(out["probabilities"].sum(1), 1, atol=1e-6)
    np.testing.assert_array_equal(out["act"], out["probabilities"].argmax(1))
    assert out["act"].dtype == np.int32


def test_full_size_shapes():
    """features.md, sections 5.5 and 5.6."""
    wanted = shapes.network_shapes(networks.default_network("bert"))
    assert wanted["embeddings.word_embeddings.weight"] == (30522, 768)
    assert sum(np.prod(shape) for shape in wanted.values()) == 108_891_648  # without the pooler
    distil = networks.complete("bert", {"config": {"layers": 6, "types": 0, "head": "Classifier"}})
    assert distil["config"]["labels"] == list(DIALOG_ACTS) and len(DIALOG_ACTS) == 38
    wanted = shapes.network_shapes(distil)
    assert wanted["classifier.weight"] == (38, 768)
    assert "embeddings.token_type_embeddings.weight" not in wanted


@pytest.mark.parametrize("config, message", [
    ({"positions": 2}, "positions: 2, expected at least 3"),
    ({"heads": 7}, "heads: 7, expected a divisor of d_model"),
    ({"labels": ["a"]}, "labels: 1, expected none"),
    ({"head": "Classifier", "labels": []}, "labels: 0, expected one for each class"),
])
def test_configurations_that_are_refused(config, message):
    with pytest.raises(ConvertError, match=message):
        networks.complete("bert", {"config": config})
