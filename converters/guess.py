"""Guesses by its tensors what network a checkpoint holds, for `inspect`."""

import json
import re

from . import names

# A key that only one kind of gestus has, the most telling first.
_MARKS = (("zs_mstm2", "face_lstm.weight_ih_l0"), ("zs_mstm1", "content_attention.in_proj_weight"),
          ("model2", "f0_encoder.embedding.weight"), ("model1", "e2_speech.lstm1.weight_ih_l0"),
          ("autoencoder", "encoder.lstm1.weight_ih_l0_reverse"),
          ("autoencoder", "decoder.lstm2.weight_ih_l0"), ("classifier", "lstm.weight_ih_l0"))


def guess(tensors):
    """Lines about what `tensors` (key -> array) look like; none when they look like nothing."""
    named = names.canonical(tensors, names.SCHEMES)
    shapes = {ours: tensors[source.keys[0]].shape for ours, source in named.sources.items()}
    if named.scheme is not None and all(len(shapes.get(key, ())) == rank for key, rank in (
            ("embeddings.word_embeddings.weight", 2), ("embeddings.position_embeddings.weight", 2),
            ("encoder.layer.0.intermediate.dense.bias", 1))):
        return _bert(named.scheme.title, shapes)
    if len(shapes.get("v.pos_embed", ())) == 3:
        return _ast(named.scheme.title if named.scheme else "a published AST", shapes)
    kind = next((kind for kind, key in _MARKS if key in shapes), None)
    return [f"looks like gestus' {kind}: --kind {kind}"] if kind else []


def _bert(title, shapes):
    tokens, d = shapes["embeddings.word_embeddings.weight"]
    config = {
        "layers": _count(shapes, r"encoder\.layer\.(\d+)\.output\.dense\.weight"), "d_model": d,
        "d_mlp": shapes["encoder.layer.0.intermediate.dense.bias"][0], "tokens": tokens,
        "positions": shapes["embeddings.position_embeddings.weight"][0],
        "types": (*shapes.get("embeddings.token_type_embeddings.weight", ()), 0)[0]}
    said = f"looks like {title}: {config['layers']} layers, d {d}"
    if "pre_classifier.weight" in shapes and len(shapes.get("classifier.bias", ())) == 1:
        config["head"] = "Classifier"
        said += f", {shapes['classifier.bias'][0]} classes"
    return [said, f"configuration for --kind bert: {json.dumps(config)}"]


def _ast(title, shapes):
    d = shapes["v.pos_embed"][-1]
    layers = _count(shapes, r"v\.blocks\.(\d+)\.mlp\.fc1\.weight")
    return [f"looks like {title}: {layers} layers, d {d}, {shapes['v.pos_embed'][-2]} positions: "
            "--kind ast, or --ast of another network"]


def _count(shapes, pattern):
    return len({found[1] for key in shapes if (found := re.fullmatch(pattern, key))})
