"""ZS-MSTM 2.0: what it shares with 1.0, and the sizes of chapter 7."""

import numpy as np
import pytest

from converters import networks, shapes, verify
from converters.errors import ConvertError
from converters.goldens import zs_mstm2 as tiny
from converters.kinds import KINDS
from converters.random_weights import random_weights

pytest.importorskip("torch")

from converters.reference.run import build, run  # noqa: E402  pylint: disable=wrong-import-position


def test_full_size_shapes():
    """models.md, section 9."""
    network = networks.default_network("zs_mstm2")
    wanted = shapes.network_shapes(network)
    assert wanted["ast_content.mlp_head.1.weight"] == (64, 768)
    assert wanted["ast_style.v.pos_embed"] == (1, 14, 768)
    assert wanted["content_attention.in_proj_weight"] == (2496, 832)
    assert wanted["face_lstm.weight_ih_l0"] == (256, 30)
    assert wanted["pose_generator.dense.weight"] == (64, 832 + 998)
    assert wanted["face_generator.head.weight"] == (30, 64)
    assert len(network["joints"]) == 11


def test_the_body_is_that_of_version_1():
    """Blind to face and tags, pose_generator is G of 1.0."""
    case = next(case for case in tiny.CASES if case.name == "zs_mstm2_autoregressive")
    network = case.network()
    weights = random_weights(network, 1)
    dense = weights["pose_generator.dense.weight"]
    dense[:, 12 + 12 + 5:] = 0  # behind h_content, self-attention and E_pose
    first = networks.complete("zs_mstm1", {"config": network["config"]["core"], "normalisations": [
        n for n in network["normalisations"] if n["stream"] != "face"]})
    renamed = {key.replace("pose_generator.", "").replace("embedding", "pose_embedding")
               if key.startswith("pose_generator") else key: x for key, x in weights.items()}
    renamed["dense.weight"] = dense[:, :12 + 12 + 5]
    kept = {key: renamed[key] for key in shapes.network_shapes(first)}
    inputs = networks.random_inputs(network, 2)
    want = run(build(first, kept), {k: x for k, x in inputs.items()
                                    if k not in ("style_face", "style_tags")})
    got = run(build(network, weights), inputs)
    assert verify.relative_error(got["pose"], want["pose"]) < 1e-6
    np.testing.assert_allclose(got["style"][:17], want["style"], rtol=1e-6)
    np.testing.assert_array_equal(got["style"][22:], inputs["style_tags"][0])


def test_every_input_reaches_the_face():
    network = tiny.CASES[0].network()
    module = build(network, random_weights(network, 1))
    inputs, other = (networks.random_inputs(network, seed) for seed in (2, 3))
    base = run(module, inputs)["face"]
    for name in inputs:
        moved = run(module, {**inputs, name: other[name]})["face"]
        assert np.abs(moved - base).max() > 0.01, name


def test_sizes_of_the_segment_reach_both_encoders():
    config = KINDS["zs_mstm2"].defaults({"core": {"frames": 32, "ast_style": {"d_out": 32}}})
    assert config["core"]["ast_content"]["frames"] == config["core"]["ast_style"]["frames"] == 32
    assert config["core"]["ast_style"]["d_out"] == 32
    with pytest.raises(ConvertError, match="config.core.attention_heads: 5, expected a divisor"):
        networks.complete("zs_mstm2", {"config": {"core": {"attention_heads": 5}}})
