"""Forwards of whole batches are the reference's, item by item, on the same weights."""

import numpy as np
import pytest

from converters import goldens, kinds, networks
from converters.goldens import model1 as model1_goldens
from converters.goldens import model2 as model2_goldens
from converters.random_weights import random_weights

torch = pytest.importorskip("torch")

# pylint: disable=wrong-import-position
from converters.reference import run as reference  # noqa: E402
from converters.training.batched import (bert, model1, model2, recurrent, small,  # noqa: E402
                                         zs_mstm)

_ZS = [case for case in goldens.cases() if case.kind in ("zs_mstm1", "zs_mstm2")]


def built(network):
    return reference.build(network, random_weights(network, 1))


def tensors(network, seed, **sizes):
    return {name: torch.from_numpy(x.astype(np.float64 if x.dtype.kind == "f" else np.int64))
            for name, x in networks.random_inputs(network, seed, **sizes).items()}


def close(got, want):
    torch.testing.assert_close(got, want, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("case", _ZS, ids=lambda case: case.name)
def test_zs_mstm(case):
    """Autoregressive decoders are taught with what they put out, so they must put it out again."""
    network = case.network()
    module, batch = built(network), [tensors(network, seed, style_segments=2) for seed in (1, 2)]
    core = network["config"].get("core", network["config"])
    together = {name: torch.stack([x[name] for x in batch]) for name in batch[0]}
    clips = {name.removeprefix("style_"): x for name, x in together.items()
             if name.startswith("style_")}
    clips = {name: x if name == "tags" else x.reshape(2, 2, core["frames"], -1)
             for name, x in clips.items()}
    with torch.no_grad():
        want = [module(x) for x in batch]
        style = zs_mstm.style_of_clips(module, clips)
        close(style, torch.stack([x["style"] for x in want]))
        content = zs_mstm.content(module.encoders, together["speech"], together["text"])
        for stream, (generator, dense) in zs_mstm.generators(module).items():
            truth, normalisation = torch.stack([x[stream] for x in want]), getattr(module, stream)
            got = zs_mstm.generate(generator, dense, content, style, normalisation.apply(truth))
            close(normalisation.undo(got), truth)


@pytest.mark.parametrize("code", ["Vector", "Sequence"])
def test_autoencoder(code):
    network = networks.complete("autoencoder", {"config": {"length": 7, "hidden": 3, "code": code}})
    module, inputs = built(network), tensors(network, 1, sequences=3)
    with torch.no_grad():
        want = module(inputs)
        x = module.values.apply(inputs["values"])
        close(module.values.undo(small.reconstruct(module, x)), want["reconstruction"])
        got = recurrent.encode(module.encoder, x[:, :, None])
        close(got if code == "Sequence" else got[:, 0], want["code"])


def taps_of(module, arrays):
    found = {}
    with torch.no_grad():
        module(arrays, lambda name, value: found.__setitem__(name, value))
    return found


def test_model1():
    network = networks.complete("model1", {"config": model1_goldens.SMALL})
    module, inputs = built(network), tensors(network, 1, words=3)
    with torch.no_grad():
        text = inputs["text"].reshape(3, -1, network["config"]["d_text"])
        got = model1.logits(module, inputs["f0"], text)
        for word in range(3):
            want = taps_of(module, {name: x[word:word + 1] for name, x in inputs.items()})
            for n, logits in enumerate(got):
                close(logits[word].softmax(-1), want[f"probabilities.{n}"])


@pytest.mark.parametrize("changes", [
    {}, {"master": "Speech"}, {"shared_norm": True}, {"conv_decoder": False},
    {"attention_width": model2_goldens.SMALL["d_text"]}, {"kernel": 5, "convolutions": 2},
    {"channels": model2_goldens.SHARED}])
def test_model2_taught_with_its_own_tokens(changes):
    network = networks.complete("model2", {"config": {**model2_goldens.SMALL, **changes}})
    c = network["config"]
    module, inputs = built(network), tensors(network, 1, words=2 * c["max_words"])
    with torch.no_grad():
        tokens = module(inputs)["tokens"]
        before = torch.cat([torch.ones_like(tokens[:, :1]), tokens[:, :-1]], 1)
        split = {name: x.reshape(2, c["max_words"], -1) for name, x in inputs.items()}
        got = model2.logits(module, split["f0"], split["text"], before)
        for window in range(2):
            words = slice(window * c["max_words"], (window + 1) * c["max_words"])
            want = taps_of(module, {name: x[words] for name, x in inputs.items()})
            for n, logits in enumerate(got):
                close(logits[window], want[f"logits.{n}"])


@pytest.mark.parametrize("head", ["None", "Classifier"])
def test_bert(head):
    config = {"layers": 2, "d_model": 8, "heads": 2, "d_mlp": 12, "tokens": 150, "positions": 9,
              "types": 2, "head": head}
    network = networks.complete("bert", {"config": config})
    module, lengths = built(network), (7, 4, 1)
    ids = tensors(network, 1, lengths=lengths)["ids"]
    wrapped = torch.zeros(3, 9, dtype=torch.long)
    for row, sequence, length in zip(wrapped, ids, lengths):
        row[:length + 2] = torch.cat([torch.tensor([module.cls]), sequence[:length],
                                      torch.tensor([module.sep])])
    padding = torch.arange(9) >= torch.tensor(lengths)[:, None] + 2
    with torch.no_grad():
        want = module({"ids": ids})
        if head == "Classifier":
            close(bert.classify(module, wrapped, padding).softmax(-1), want["probabilities"])
            return
        got = bert.encode(module, wrapped, padding)[:, 1:-1]
        for n, length in enumerate(lengths):
            close(got[n, :length], want["hidden"][n, :length])


def test_classifier_and_discriminator():
    network = networks.complete("classifier", {"config": {"frames": 4, "d_in": 6, "layers": 2,
                                                          "hidden": 5}})
    module, inputs = built(network), tensors(network, 1, segments=3)
    with torch.no_grad():
        got = small.strength(module, inputs["motion"].reshape(3, 4, 6))
        close(got.sigmoid(), module(inputs)["strength"])
    for pool in ("Mean", "First", "Last"):
        network = networks.complete("discriminator", {"config": {
            "rows": 3, "d_content": 6, "d_style": 4, "hidden": 5, "layers": 2, "pool": pool}})
        module, inputs = built(network), tensors(network, 1, segments=2)
        with torch.no_grad():
            close(small.discriminate(module, inputs["content"].reshape(2, 3, 6)),
                  module(inputs)["style"])


def test_every_kind_that_is_trained_has_a_task():
    from converters.training import tasks
    assert {tasks.of(name).kind for name in tasks.TASKS} == set(kinds.KINDS) - {
        "ast", "discriminator"}  # which are trained inside ZS-MSTM
