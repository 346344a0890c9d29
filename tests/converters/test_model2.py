"""Model 2: what sees what, against PyTorch's own layers, and the properties that an engine which
decodes step by step relies on."""

import numpy as np
import pytest

from converters import goldens, networks, shapes
from converters.errors import ConvertError
from converters.goldens.model2 import CHANNELS, SHARED, SMALL
from converters.random_weights import random_weights

torch = pytest.importorskip("torch")

# pylint: disable=wrong-import-position
from converters.reference import blocks, model2  # noqa: E402
from converters.reference.run import build, run  # noqa: E402
from converters.reference.sampling import Sampler  # noqa: E402


def make(changes=()):
    network = networks.complete("model2", {"config": {**SMALL, **dict(changes)}})
    return network, build(network, random_weights(network, 1))


def random(*shape):
    return torch.from_numpy(np.random.default_rng(5).standard_normal(shape))


def test_units_are_alone_and_filled_up_with_zeros():
    network, module = make()
    inputs = networks.random_inputs(network, 1, words=7)
    whole = run(module, inputs)
    assert whole["tokens"].shape == (3, 9, 3) and whole["lengths"].shape == (3, 3)
    for i, words in enumerate((slice(0, 3), slice(3, 6), slice(6, 7))):
        alone = {name: x[words] for name, x in inputs.items()}
        filled = {name: np.pad(x, ((0, 3 - len(x)), (0, 0))) for name, x in alone.items()}
        for arrays in (alone, filled):
            np.testing.assert_array_equal(run(module, arrays)["tokens"][0], whole["tokens"][i])


def test_longer_sequences_begin_like_shorter_ones():
    network, module = make()
    _, short = make({"max_out": 4})
    inputs = networks.random_inputs(network, 1)
    long = run(module, inputs)["tokens"]
    np.testing.assert_array_equal(run(short, inputs)["tokens"], long[:, :4])


def test_speech_is_encoded_word_by_word_and_text_is_causal():
    network, module = make({"encoder_layers": 2})
    inputs = networks.random_inputs(network, 1)
    base = run(module, inputs, taps=True)
    changed = {name: x.copy() for name, x in inputs.items()}
    changed["f0"][1] += 30
    moved = run(module, changed, taps=True)
    same = np.array_equal
    for name in ("tap/f0_encoder/out", "tap/encoder.0/out", "tap/encoder.1/out"):
        assert same(moved[name][:5], base[name][:5]) and same(moved[name][10:], base[name][10:])
        assert not same(moved[name][5:10], base[name][5:10])
    changed = {"f0": inputs["f0"], "text": inputs["text"].copy()}
    changed["text"][1] += 1
    moved = run(module, changed, taps=True)["tap/cross/out"]
    still = base["tap/cross/out"]
    assert same(moved[0], still[0]) and not np.allclose(moved[2], still[2])


def test_a_word_of_text_repeated_is_one_key():
    """Speech asks: L equal keys share the weight of one, so the engine needs only W of them."""
    _, module = make({"master": "Speech"})
    speech, text = random(3, 5, 8), random(3, 6)
    with torch.no_grad():
        torch.testing.assert_close(module.cross.layer(speech.flatten(0, 1), text),
                                   module.cross(speech, text), rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("layers, kernel", [(1, 3), (2, 3), (3, 3), (2, 5)])
def test_the_newest_row_of_the_convolutions_needs_few_rows(layers, kernel):
    """'same' on the prefix: layers * (kernel / 2) rows before the newest, and none after it."""
    _, module = make({"convolutions": layers, "kernel": kernel})
    x, needed = random(12, 24), layers * (kernel // 2) + 1
    with torch.no_grad():
        whole, end = module.conv_decoder(x), module.conv_decoder(x[-needed:])
        torch.testing.assert_close(end[-1], whole[-1], rtol=1e-10, atol=1e-12)
        assert not torch.allclose(module.conv_decoder(x[1 - needed:])[-1], whole[-1])
        longer = module.conv_decoder(torch.cat([x, random(1, 24)]))
        assert not torch.allclose(longer[-2], whole[-1])  # what was put out would change later


def packed(attention):
    """The weights of nn.MultiheadAttention that `attention` has apart."""
    parts = [attention.query, attention.key, attention.value]
    return {"in_proj_weight": torch.cat([p.weight for p in parts]),
            "in_proj_bias": torch.cat([p.bias for p in parts]),
            "out_proj.weight": attention.out.weight, "out_proj.bias": attention.out.bias}


def test_layers_are_those_of_vaswani():
    """With scaled scores, PyTorch's own encoder and decoder layers."""
    _, module = make({"scale": "Rsqrt"})
    theirs = {"encoder": torch.nn.TransformerEncoderLayer(8, 2, 12, 0.0, layer_norm_eps=1e-6),
              "decoder": torch.nn.TransformerDecoderLayer(8, 2, 12, 0.0, layer_norm_eps=1e-6)}
    ours = {"encoder": module.encoder["layers"][0], "decoder": module.decoders[0].layers[0]}
    x, memory = random(6, 8), random(4, 8)
    with torch.no_grad():
        for name, layer in theirs.items():
            state = {key: value for key, value in ours[name].state_dict().items()
                     if "attn" not in key}
            for ours_name, their_name in (("self_attn", "self_attn"),
                                          ("cross_attn", "multihead_attn")):
                if hasattr(ours[name], ours_name):
                    state |= {f"{their_name}.{key}": value
                              for key, value in packed(getattr(ours[name], ours_name)).items()}
            layer.double().eval().load_state_dict(state)
        torch.testing.assert_close(ours["encoder"](x), theirs["encoder"](x))
        torch.testing.assert_close(ours["decoder"](x, memory), theirs["decoder"](
            x, memory, tgt_mask=blocks.causal_mask(6)))


def test_scores_are_not_scaled_by_default():
    """Scaled scores of queries twice as large (d = 8, 2 heads) are those of eq. 5.12."""
    attention = {scale: model2.Attention({"d_model": 8, "scale": scale}, 2).double()
                 for scale in ("None", "Rsqrt")}
    state = attention["None"].state_dict()
    attention["Rsqrt"].load_state_dict({key: 2 * x if "query" in key else x
                                        for key, x in state.items()})
    x = random(5, 8)
    with torch.no_grad():
        torch.testing.assert_close(attention["None"](x, x), attention["Rsqrt"](x, x))


def test_f0_is_quantised_to_the_nearest_level():
    _, module = make({"f0_step": 1.0, "f0_tokens": 500})
    hertz = torch.tensor([0.0, -5, 0.4, 49, 50, 51.4, 51.6, 300.2, 549, 551, 1e6])
    assert module.f0_ids(hertz).tolist() == [0, 0, 1, 1, 1, 1, 2, 250, 499, 499, 499]


def test_the_generator_is_the_standard_one():
    """The first outputs of MT19937 with its standard seed (ISO C++: the 10,000th is 4123659995)."""
    stream = Sampler(1.0, 0, 5489)
    values = [stream.uniform() for _ in range(10000)]
    assert values[0] == (3499211612 >> 8) / 2 ** 24 and values[-1] == (4123659995 >> 8) / 2 ** 24


def test_draws():
    logits = torch.tensor([1.0, 3.0, 2.0, 3.0, 0.0], dtype=torch.float64)
    assert {Sampler(5.0, 1, seed)(logits) for seed in range(20)} == {1}  # the lower of equals
    assert {Sampler(5.0, 2, seed)(logits) for seed in range(20)} == {1, 3}
    assert {Sampler(1e-3, 0, seed)(logits) for seed in range(20)} == {1, 3}
    draws, sampler = np.zeros(5), Sampler(0.5, 3, 1)
    for _ in range(4000):
        draws[sampler(logits)] += 1 / 4000
    p = np.exp(2 * logits.numpy()) * [0, 1, 1, 1, 0]
    np.testing.assert_allclose(draws, p / p.sum(), atol=0.03)


def test_runs_with_one_seed_are_alike():
    network, module = make()
    inputs = networks.random_inputs(network, 1, words=6)
    runs = [run(module, inputs, temperature=2.0, seed=seed)["tokens"] for seed in (3, 3, 4)]
    np.testing.assert_array_equal(runs[0], runs[1])
    assert not np.array_equal(runs[0], runs[2])


@pytest.mark.parametrize("case", [case for case in goldens.cases()
                                  if case.kind in ("model1", "model2")], ids=lambda c: c.name)
def test_goldens_pick_clear_winners(case):
    """Single precision picks the same tokens, so rounding in an engine must too."""
    network = case.network()
    weights = random_weights(network, goldens.SEED)
    inputs = networks.random_inputs(network, goldens.SEED, **case.sizes)
    want = run(build(network, weights), inputs, **case.options)["tokens"]
    with torch.no_grad():
        single = {name: torch.from_numpy(x) for name, x in inputs.items()}
        got = build(network, weights).float()(single, **case.options)["tokens"]
    np.testing.assert_array_equal(got, want)
    assert len(np.unique(want)) >= 5


def test_parameters():
    """The blocks of models.md, section 4.4."""
    def count(config, prefix):
        wanted = shapes.network_shapes(networks.complete("model2", {"config": config}))
        return sum(np.prod(shape) for key, shape in wanted.items() if key.startswith(prefix))
    assert count({}, "encoder.layers.0.") == 68_560
    assert count({}, "decoders.0.layers.3.") == 85_328
    assert count({"shared_norm": True}, "decoders.0.layers.0.") == 85_200
    assert count({}, "conv_decoder.") == 135_360
    assert count({}, "heads.0.") == 65 * 503
    released = {"master": "Speech", "attention_ff": 128, "shared_norm": True}
    assert count(released, "cross.") == 140_224


def test_channels_share_stacks():
    network = networks.complete("model2", {"config": {**SMALL, "channels": SHARED}})
    wanted = shapes.network_shapes(network)
    assert not any(key.startswith("decoders.2.") for key in wanted)
    assert wanted["decoders.1.embedding.weight"] == (16, 8) and "heads.2.bias" in wanted
    separate = networks.default_network("model2")
    assert [c["stack"] for c in separate["config"]["channels"]] == list(range(9))


@pytest.mark.parametrize("config, message", [
    ({"kernel": 4}, "kernel: 4, expected an odd number"),
    ({"attention_width": 7}, "attention_width: 7, expected d_model 8 or d_text 6"),
    ({"attention_width": 6, "master": "Speech"}, "attention_width: 6, expected d_model 8 with"),
    ({"decoder_heads": 3}, "decoder_heads: 3, expected a divisor of d_model = 8"),
    ({"channels": [CHANNELS[0], {**CHANNELS[1], "stack": 2}]}, "AU04.stack: 2, expected 1"),
    ({"channels": [{**channel, "stack": 0} for channel in CHANNELS]}, "Rx.levels: 13, expected 17"),
    ({"f0_tokens": 1}, "f0_tokens: 1, expected at least 2"),
    ({"convolutions": 0}, "convolutions: 0, expected at least 1"),
])
def test_configurations_that_are_refused(config, message):
    with pytest.raises(ConvertError, match=message):
        networks.complete("model2", {"config": {**SMALL, **config}})
