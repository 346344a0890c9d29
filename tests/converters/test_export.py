"""The commands, from checkpoint to weights file and back."""

import json
import os

import numpy as np
import pytest

from converters import goldens, kinds, networks, shapes, weights_file
from converters.__main__ import main
from converters.errors import ConvertError
from converters.random_weights import random_weights, save_checkpoint

torch = pytest.importorskip("torch")


@pytest.fixture
def checkpoint(tmp_path, tiny):
    path = tmp_path / "model.pt"
    save_checkpoint(path, random_weights(tiny, 1))
    return path


def export(checkpoint, config, *options, output=None):
    output = output or str(checkpoint) + ".fb"
    code = main(["export", str(checkpoint), "-o", output, "--config", str(config), *options])
    return code, output


def test_export_keeps_every_tensor(checkpoint, tiny_config, tiny):
    code, output = export(checkpoint, tiny_config, "--trained", "--trained-on", "PATS",
                          "--trained-at", "2024-01-02", "--recipe", "r", "--licence", "MIT")
    assert code == 0
    file = weights_file.read(output)
    for key, want in random_weights(tiny, 1).items():
        np.testing.assert_array_equal(file.tensors[key], want)
    p = file.provenance
    assert (p["trained"], p["trained_on"], p["trained_at"], p["recipe"], p["licence"]) == (
        True, "PATS", "2024-01-02", "r", "MIT")
    assert p["source"].startswith("model.pt sha256:") and "gestus" in p["converter"]
    test = file.networks[0]["self_test"]
    assert test["input_names"] == ["speech", "text", "style_speech", "style_text", "style_pose"]
    assert file.tensors[test["output"]].shape == (8, 6)
    assert set(file.network_tensors(file.networks[0])) == set(shapes.network_shapes(tiny))


def test_export_again_is_byte_identical(checkpoint, tiny_config, tmp_path):
    _, first = export(checkpoint, tiny_config)
    _, second = export(checkpoint, tiny_config, output=str(tmp_path / "second.fb"))
    with open(first, "rb") as a, open(second, "rb") as b:
        assert a.read() == b.read()


def changed(checkpoint, change):
    state = torch.load(checkpoint)
    change(state)
    torch.save(state, checkpoint)


@pytest.mark.parametrize("change, message", [
    (lambda s: s.pop("dense.bias"), "dense.bias: missing, expected (16,)"),
    (lambda s: s.update({"dense.bias": torch.zeros(17)}), "dense.bias: (17,), expected (16,)"),
    (lambda s: s.update({"extra.bias": torch.zeros(17)}), "extra.bias: (17,), not part"),
    (lambda s: s.update({"dense.bias": torch.zeros(16).long()}), "dense.bias: int64, expected"),
    (lambda s: s.update({"dense.bias": torch.full((16,), np.nan)}), "not finite"),
    (lambda s: s.update({"dense.bias": torch.full((16,), 1e300, dtype=torch.float64)}),
     "not finite"),
    (lambda s: [s.pop(k) for k in list(s) if k.startswith("ast_style.")], "and 23 more"),
])
def test_export_refuses(checkpoint, tiny_config, capfd, change, message):
    changed(checkpoint, change)
    code, output = export(checkpoint, tiny_config, "--no-self-test")
    assert code == 2 and not os.path.exists(output)
    error = capfd.readouterr().err
    assert message in error and error.count("\n") == 1


def test_known_and_allowed_unused_tensors_are_reported(checkpoint, tiny_config, capfd):
    changed(checkpoint, lambda s: s.update({"ast_content.v.head.weight": torch.zeros(2, 3)}))
    assert export(checkpoint, tiny_config, "--no-self-test")[0] == 0
    assert "unused: ast_content.v.head.weight (2, 3)" in capfd.readouterr().out
    changed(checkpoint, lambda s: s.update({"extra": torch.zeros(2)}))
    assert export(checkpoint, tiny_config, "--no-self-test")[0] == 2
    assert export(checkpoint, tiny_config, "--no-self-test", "--allow-unused")[0] == 0
    assert "unused: extra (2,)" in capfd.readouterr().out


def published_ast(path, colours=3, rows=24 * 24):
    """A checkpoint with the published keys, prefix, head and ImageNet geometry, and tiny widths."""
    ast = networks.complete("ast", {"config": goldens.AST})
    state = {"module." + key: torch.from_numpy(x) for key, x in random_weights(ast, 2).items()}
    state["module.v.pos_embed"] = torch.randn(1, 2 + rows, 16)
    state["module.v.patch_embed.proj.weight"] = torch.randn(16, colours, 4, 4)
    state["module.v.head.weight"] = torch.zeros(1000, 16)
    state["module.mlp_head.1.weight"] = torch.zeros(527, 16)
    torch.save(state, path)
    return state


def test_ast_from_a_published_checkpoint(checkpoint, tiny_config, tmp_path, capfd):
    changed(checkpoint, lambda s: [s.pop(k) for k in list(s) if k.startswith("ast_")])
    state = published_ast(tmp_path / "ast.pth")
    code, output = export(checkpoint, tiny_config, "--ast", str(tmp_path / "ast.pth"))
    assert code == 0
    text = capfd.readouterr().out
    assert "24 x 24 patches adapted to 5 x 2" in text and "three colours" in text
    file = weights_file.read(output)
    for part in ("ast_content.", "ast_style."):
        np.testing.assert_array_equal(file.tensors[part + "v.blocks.1.attn.qkv.weight"],
                                      state["module.v.blocks.1.attn.qkv.weight"])
        assert file.tensors[part + "v.pos_embed"].shape == (1, 12, 16)
    assert ", ast.pth sha256:" in file.provenance["source"]


def test_ast_alone(tmp_path, capfd):
    published_ast(tmp_path / "ast.pth", 1, 12 * 101)
    config = tmp_path / "ast.json"
    config.write_text(json.dumps(goldens.AST))
    code, output = export(tmp_path / "ast.pth", config, "--kind", "ast")
    assert code == 0 and "12 x 101 patches" in capfd.readouterr().out
    assert weights_file.read(output).tensors["v.patch_embed.proj.weight"].shape == (16, 1, 4, 4)


def test_random_then_export_gives_the_same_tensors(tmp_path, tiny_config):
    random, saved = str(tmp_path / "r.fb"), str(tmp_path / "r.pt")
    assert main(["random", "--seed", "5", "--config", str(tiny_config), "-o", random,
                 "--checkpoint-out", saved]) == 0
    file = weights_file.read(random)
    assert not file.provenance["trained"] and "seed 5" in file.provenance["recipe"]
    code, output = export(tmp_path / "r.pt", tiny_config)
    assert code == 0
    again = weights_file.read(output)
    for name, x in file.tensors.items():
        np.testing.assert_array_equal(again.tensors[name], x)


def test_example_is_whole_or_not_there(checkpoint, tiny_config, tmp_path, monkeypatch, capfd):
    _, weights = export(checkpoint, tiny_config)
    output, network = tmp_path / "input.npz", weights_file.read(weights).networks[0]
    assert main(["example", weights, "-o", str(output), "--seed", "3"]) == 0
    first = output.read_bytes()
    with np.load(output) as arrays:
        want = networks.random_inputs(network, 3)
        assert set(arrays.files) == set(want)
        for name, x in want.items():
            np.testing.assert_array_equal(arrays[name], x)

    def fail(*_):
        raise OSError(28, "No space left on device", str(output))

    before = sorted(os.listdir(tmp_path))
    monkeypatch.setattr(weights_file.os, "fsync", fail)
    assert main(["example", weights, "-o", str(output), "--seed", "4"]) == 2
    assert "No space left" in capfd.readouterr().err
    assert output.read_bytes() == first and sorted(os.listdir(tmp_path)) == before


@pytest.mark.parametrize("command", [["random", "-o", "x.fb"], ["verify", "x.fb"],
                                     ["example", "x.fb", "-o", "x.npz"]])
def test_seeds_below_zero(command, capfd):
    assert main([*command, "--seed", "-1"]) == 2
    assert capfd.readouterr().err == "converters: --seed: -1, expected 0 or more\n"


def test_inspect(checkpoint, tiny_config, capfd):
    _, output = export(checkpoint, tiny_config)
    assert main(["inspect", output]) == main(["inspect", str(checkpoint)]) == 0
    text = capfd.readouterr().out
    assert "network zs_mstm1: ZsMstm1Config" in text and "trained: False" in text
    assert text.count("dense.bias  (16,)  float32") == 2


@pytest.mark.parametrize("fields, message", [
    ({"d_modell": 3}, "unknown field: d_modell"),
    ({"decoder_mode": "Backwards"}, "unknown enum value: Backwards"),
    ({"decoder_heads": 5}, "decoder_heads: 5, expected a divisor of d_model = 768"),
    ({"frames": 10}, "frames: 64, expected 10"),
    ({"context_segments": 2}, "context_segments: 2, expected 1 with granularity Frame"),
    ({"ast_shared": True, "ast_style": {}}, "ast_style: present, expected the opposite"),
    ({"ast_content": {"stride": 17}}, "stride: 17, expected at most patch 16"),
    ({"ast_content": {"d_out": 9}}, "d_out: 9, expected d_model 768 without a head"),
    ({"lstm_hidden": 0}, "lstm_hidden: 0, expected at least 1"),
    ({"normalisations": [{"stream": "f0", "mean": [0], "deviation": [1]}]}, "normalisation of f0"),
    ({"normalisations": [{"stream": "pose", "mean": [0, 1], "deviation": [1]}]}, "2 means"),
    ({"normalisations": [{"stream": "pose", "mean": [0], "deviation": [0]}]}, "above zero"),
    ({"joints": [{"name": "Neck"}]}, "joints: 1, expected half of d_pose 22"),
    ([], "expected an object"),
])
def test_configurations_that_are_refused(tmp_path, capfd, fields, message):
    config = tmp_path / "c.json"
    config.write_text(json.dumps(fields))
    assert main(["random", "--config", str(config), "-o", str(tmp_path / "x.fb")]) == 2
    error = capfd.readouterr().err
    assert message in error and error.count("\n") == 1


def test_full_size_shapes():
    """The numbers of models.md, sections 7 and 8."""
    wanted = shapes.network_shapes(networks.default_network("zs_mstm1"))
    assert wanted["ast_content.v.pos_embed"] == (1, 62, 768)
    assert wanted["content_attention.in_proj_weight"] == (4608, 1536)
    assert wanted["dense.weight"] == (768, 3840)
    assert wanted["pose_lstm.weight_ih_l0"] == (3072, 22)
    assert wanted["head.weight"] == (22, 768)


def test_missing_file(tmp_path, capfd):
    assert main(["inspect", str(tmp_path / "none.pt")]) == 2
    assert "none.pt: No such file" in capfd.readouterr().err


def test_flatc_missing(monkeypatch):
    monkeypatch.setenv("PATH", "/nonexistent")
    with pytest.raises(ConvertError, match="install flatbuffers-compiler"):
        networks.default_network("ast")


@pytest.mark.parametrize("kind", list(kinds.KINDS))
def test_demo_networks_are_complete(kind):
    network = networks.demo_network(kind)
    assert kinds.kind_of(network) == kind and network["name"] == kind
    assert networks.random_inputs(network, 1)
