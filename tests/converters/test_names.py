"""Published checkpoints under the names that people have them, to weights files."""

import json
import re

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from conftest import same, weights  # noqa: E402
from converters import goldens  # noqa: E402
from converters.__main__ import main  # noqa: E402
from converters.errors import ConvertError  # noqa: E402
from converters.names import AST, BERT, DISTILBERT, canonical  # noqa: E402
from converters.random_weights import random_weights, save_checkpoint  # noqa: E402
from test_safetensors import encode  # noqa: E402

CONFIG = {"layers": 2, "d_model": 16, "heads": 4, "d_mlp": 24, "tokens": 110, "positions": 12}
DISTIL = {**CONFIG, "types": 0, "head": "Classifier", "labels": ["yes", "no", "perhaps"]}
THEIRS = {  # of DistilBERT, by ours
    "attention.self.query": "attention.q_lin", "attention.self.key": "attention.k_lin",
    "attention.self.value": "attention.v_lin", "attention.output.dense": "attention.out_lin",
    "attention.output.LayerNorm": "sa_layer_norm", "intermediate.dense": "ffn.lin1",
    "output.dense": "ffn.lin2", "output.LayerNorm": "output_layer_norm"}


def distil_name(key):
    found = re.fullmatch(r"encoder\.layer\.(\d+)\.(.*)\.(weight|bias)", key)
    if found:
        return f"distilbert.transformer.layer.{found[1]}.{THEIRS[found[2]]}.{found[3]}"
    return "distilbert." + key if key.startswith("embeddings") else key


def hf_ast_names(tensors):
    """As Hugging Face's port of AST splits and names them."""
    found = {}
    for key, x in tensors.items():
        block = re.fullmatch(r"v\.blocks\.(\d+)\.(.*)\.(weight|bias)", key)
        if block:
            layer, end = f"encoder.layer.{block[1]}.", "." + block[3]
            if block[2] == "attn.qkv":
                for part, rows in zip(("query", "key", "value"), np.split(x, 3)):
                    found[layer + "attention.attention." + part + end] = rows.copy()
                continue
            found[layer + {"norm1": "layernorm_before", "norm2": "layernorm_after",
                           "attn.proj": "attention.output.dense", "mlp.fc1": "intermediate.dense",
                           "mlp.fc2": "output.dense"}[block[2]] + end] = x
        else:
            head = "classifier." if key.startswith("mlp_head") else ""
            for ours, theirs in (("v.cls_token", "embeddings.cls_token"),
                                 ("v.dist_token", "embeddings.distillation_token"),
                                 ("v.pos_embed", "embeddings.position_embeddings"),
                                 ("v.patch_embed.proj", "embeddings.patch_embeddings.projection"),
                                 ("v.norm", "layernorm"), ("mlp_head.0", head + "layernorm"),
                                 ("mlp_head.1", head + "dense")):
                key = key.replace(ours, theirs)
            found[key] = x
    return {key if key.startswith("classifier.") else "audio_spectrogram_transformer." + key: x
            for key, x in found.items()}


@pytest.mark.parametrize("prefix", ["", "bert.", "module.bert."])
@pytest.mark.parametrize("old", [False, True])
def test_bert(tmp_path, export, prefix, old):
    want = weights("bert", CONFIG)
    theirs = {prefix + key: x for key, x in want.items()}
    if old:
        theirs = {key.replace("LayerNorm.weight", "LayerNorm.gamma").replace(
            "LayerNorm.bias", "LayerNorm.beta"): x for key, x in theirs.items()}
    head = "module." * prefix.startswith("module.")
    more = {head + "cls.predictions.bias": np.ones(3, np.float32),
            head + "cls.seq_relationship.weight": np.ones((2, 16), np.float32),
            head + "classifier.weight": np.ones((2, 16), np.float32),
            prefix + "pooler.dense.weight": np.ones((16, 16), np.float32),
            prefix + "embeddings.position_ids": np.arange(12)[None]}
    save_checkpoint(tmp_path / "bert.pt", theirs | more)
    code, tensors, said = export(tmp_path / "bert.pt", "bert", CONFIG)
    assert code == 0, said
    same(tensors, want)
    assert "names of Hugging Face BERT" in said
    assert f"tensors: {len(want)} used, 5 unused, 0 missing" in said
    assert "unused: cls.predictions.bias (3,)" in said


@pytest.mark.parametrize("prefix", [True, False])
def test_distilbert_from_safetensors(tmp_path, export, prefix):
    want = weights("bert", DISTIL)
    theirs = {distil_name(key): x for key, x in want.items()}
    if not prefix:
        theirs = {key.removeprefix("distilbert."): x for key, x in theirs.items()}
    theirs["vocab_projector.bias"] = np.ones(110, np.float32)
    (tmp_path / "model.safetensors").write_bytes(encode(theirs, {"format": "pt"}))
    code, tensors, said = export(tmp_path / "model.safetensors", "bert", DISTIL)
    assert code == 0, said
    same(tensors, want)
    assert "names of Hugging Face DistilBERT" in said


def test_distilbert_of_tensorflow(tmp_path, export):
    """tf_model.h5 as Hugging Face's TensorFlow classes save it."""
    keras = pytest.importorskip("keras_file")
    want, top = weights("bert", DISTIL), "tf_distil_bert_for_sequence_classification/"
    groups = {"distilbert": {}, "dropout_19": {}, "pre_classifier": {}, "classifier": {}}
    for key, x in want.items():
        *module, end = distil_name(key).split(".")
        name = {"weight": "gamma", "bias": "beta"}[end] if "norm" in module[-1].lower() else {
            "weight": "kernel", "bias": "bias"}[end]
        if module[-1] == "word_embeddings":
            name = "weight"
        elif module[-1] == "position_embeddings":
            name = "embeddings"
        group = module[0]
        path = "/".join(module).replace("layer/", "layer_._") + f"/{name}:0"
        groups[group][top + path] = x.T if name == "kernel" else x
    keras.write_weights(tmp_path / "tf_model.h5",
                        [("", {"name": name}, arrays) for name, arrays in groups.items()])
    code, tensors, said = export(tmp_path / "tf_model.h5", "bert", DISTIL)
    assert code == 0, said
    same(tensors, want)
    assert "names of Hugging Face DistilBERT" in said and "no model_config" in said


def test_bert_that_lacks_a_classifier_is_refused_by_name(tmp_path, export):
    save_checkpoint(tmp_path / "bert.pt", weights("bert", CONFIG))
    code, _, said = export(tmp_path / "bert.pt", "bert", {**CONFIG, "head": "Classifier"})
    assert code == 2 and "missing: pre_classifier.weight (16, 16)" in said
    assert "pre_classifier.weight: missing, expected (16, 16)" in said


def test_types_are_not_dropped_silently(tmp_path, export):
    save_checkpoint(tmp_path / "bert.pt", weights("bert", CONFIG))
    code, _, said = export(tmp_path / "bert.pt", "bert", {**CONFIG, "types": 0})
    assert code == 2 and "token_type_embeddings.weight: (2, 16), not part of this network" in said


AST_CONFIG = {**goldens.AST, "head": "LayerNormLinear", "d_out": 5}


@pytest.fixture
def hf_ast(tmp_path):
    want = weights("ast", AST_CONFIG)
    save_checkpoint(tmp_path / "ast.pt", hf_ast_names(want))
    return tmp_path / "ast.pt", want


def test_hugging_faces_ast(hf_ast, export):
    path, want = hf_ast
    code, _, said = export(path, "ast", AST_CONFIG)
    assert code == 2 and "encoder.layer.0.layernorm_before: LayerNorm epsilon 1e-12, expected " \
        "1e-06 as config.ln_eps (--keep-epsilon takes that)" in said
    code, _, said = export(path, "ast", {**AST_CONFIG, "ln_eps": 1e-12})
    assert code == 2 and "classifier.layernorm: LayerNorm epsilon 1e-12, expected 1e-05" in said
    assert "encoder.layer.0" not in said
    code, tensors, said = export(path, "ast", AST_CONFIG, "--keep-epsilon")
    assert code == 0 and "names of Hugging Face AST" in said
    same(tensors, want)


def test_hugging_faces_ast_inside_a_network(hf_ast, tmp_path, export, tiny, tiny_config):
    """As --ast, and as a part of the checkpoint itself."""
    tensors = random_weights(tiny, 1)
    own = {key: x for key, x in tensors.items() if not key.startswith("ast_")}
    save_checkpoint(tmp_path / "own.pt", own)
    config = json.loads(tiny_config.read_text())
    config["ast_content"] = config["ast_style"] = {**goldens.AST, "ln_eps": 1e-12}
    code, found, said = export(tmp_path / "own.pt", "zs_mstm1", config, "--ast", hf_ast[0])
    assert code == 0, said
    np.testing.assert_array_equal(found["ast_style.v.blocks.0.attn.qkv.weight"],
                                  hf_ast[1]["v.blocks.0.attn.qkv.weight"])
    parts = {part: {key.removeprefix(part): x for key, x in tensors.items()
                    if key.startswith(part)} for part in ("ast_content.", "ast_style.")}
    save_checkpoint(tmp_path / "all.pt", own | {
        part + key: x for part, inner in parts.items() for key, x in hf_ast_names(inner).items()})
    code, found, said = export(tmp_path / "all.pt", "zs_mstm1", config)
    assert code == 0, said
    same(found, tensors)


@pytest.mark.parametrize("change, message", [
    (lambda t: t.pop("audio_spectrogram_transformer.encoder.layer.1.attention.attention.key.bias"),
     "v.blocks.1.attn.qkv.bias: made of query, key and value"),
    (lambda t: t.update({"audio_spectrogram_transformer.encoder.layer.1.attention.attention.key."
                         "bias": np.ones((3, 3), np.float32)}), "cannot be joined along axis 0"),
])
def test_hugging_faces_ast_with_parts_that_do_not_join(tmp_path, export, change, message):
    theirs = hf_ast_names(weights("ast", AST_CONFIG))
    change(theirs)
    save_checkpoint(tmp_path / "ast.pt", theirs)
    code, _, said = export(tmp_path / "ast.pt", "ast", AST_CONFIG)
    assert code == 2 and message in said


def test_two_tensors_for_one_name():
    keys = ["bert.embeddings.word_embeddings.weight", "x.y", "bert.x.y",
            "bert.encoder.layer.0.attention.self.query.weight"]
    with pytest.raises(ConvertError, match="x.y: both x.y and bert.x.y would be it"):
        canonical(keys, [BERT])


def test_roberta_is_not_taken_for_bert():
    keys = ["roberta.embeddings.word_embeddings.weight",
            "roberta.encoder.layer.0.attention.self.query.weight"]
    assert canonical(keys, [DISTILBERT, BERT, AST]).scheme is None


@pytest.mark.parametrize("kind, config, name, said", [
    ("bert", CONFIG, lambda t: t, ["Hugging Face BERT: 2 layers, d 16",
                                   '"d_mlp": 24, "tokens": 110, "positions": 12, "types": 2}']),
    ("bert", DISTIL, lambda t: {distil_name(key): x for key, x in t.items()},
     ["looks like Hugging Face DistilBERT: 2 layers, d 16, 3 classes", '"head": "Classifier"}']),
    ("ast", AST_CONFIG, hf_ast_names,
     ["looks like Hugging Face AST: 2 layers, d 16, 12 positions"]),
    ("ast", AST_CONFIG, lambda t: t, ["looks like a published AST: 2 layers, d 16"]),
    ("autoencoder", {"hidden": 3}, lambda t: t, ["looks like gestus' autoencoder"]),
    ("classifier", {"hidden": 3}, lambda t: t, ["looks like gestus' classifier"]),
])
def test_inspect_guesses(tmp_path, capfd, kind, config, name, said):
    tensors = name(weights(kind, config))
    (tmp_path / "x.safetensors").write_bytes(encode(tensors))
    assert main(["inspect", str(tmp_path / "x.safetensors")]) == 0
    text = capfd.readouterr().out
    assert "x.safetensors: safetensors" in text and all(x in text for x in said)
    count = sum(x.size for x in tensors.values())
    assert f"{len(tensors)} tensors, {count:,} parameters" in text


def test_report_files(tmp_path, export):
    want = weights("bert", CONFIG)
    want.pop("embeddings.LayerNorm.bias")
    want["embeddings.LayerNorm.weight"] = np.ones(3, np.float32)
    save_checkpoint(tmp_path / "bert.pt", {**{"bert." + key: x for key, x in want.items()},
                                           "other": np.ones(2, np.float32)})
    for name in ("report.json", "report.txt"):
        code, _, said = export(tmp_path / "bert.pt", "bert", CONFIG, "--report", tmp_path / name)
        assert code == 2 and "1 unused, 1 missing, 1 misshapen" in said
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["format"] == "PyTorch zip" and report["config_type"] == "BertConfig"
    assert report["missing"] == {"embeddings.LayerNorm.bias": {"shape": [16], "why": None}}
    assert report["misshapen"] == {"embeddings.LayerNorm.weight": {"found": "(3,)",
                                                                   "expected": "(16,)"}}
    assert report["unused"] == {"other": {"shape": [2], "why": None}}
    assert report["used"]["encoder.layer.0.output.dense.bias"] == [
        "bert.encoder.layer.0.output.dense.bias"]
    assert len(report["used"]) == len(want) - 1
    text = (tmp_path / "report.txt").read_text()
    assert "missing: embeddings.LayerNorm.bias (16,)" in text
    assert "used: encoder.layer.0.output.dense.bias from bert.encoder" in text
