"""ZS-MSTM 1.0 (thesis chapter 6)."""

import numpy as np

from .. import layers
from ..checks import divides, expect, positive
from ..kind import Kind
from . import ast

# PATS' first eleven joints (features.md, section 6), their parents, and a figure at rest in units
# of pose/normalize (167 from neck to right shoulder, y down), relative to the neck.
PATS_JOINTS = (
    ("Neck", -1, (0, 0)), ("RShoulder", 0, (-166, 14)), ("RElbow", 1, (-205, 235)),
    ("RWrist", 2, (-95, 335)), ("LShoulder", 0, (166, 14)), ("LElbow", 4, (205, 235)),
    ("LWrist", 5, (95, 335)), ("Nose", 0, (0, -135)), ("REye", 7, (-26, -165)),
    ("LEye", 7, (26, -165)), ("LHandRoot", 6, (70, 350)),
)
# How far an untrained figure moves: deviations of the joints above, in the same units.
_MOTION = (4, 6, 28, 60, 6, 28, 60, 10, 10, 10, 66)
POSE = {"stream": "pose", "deviation": list(_MOTION) * 2,
        "mean": np.array([at for _, _, at in PATS_JOINTS], float).T.ravel().tolist()}

# Queries and keys are large for the reason that ast.py gives.
GAINS = {"multihead_attn.in_proj_weight": 3.0, "in_proj_weight": 2.0, **ast.GAINS,
         "weight_ih_l": 2.5, "weight_hh_l": 1.5, "pose_embedding.weight": 0.5}


def style_ast(c):
    return c["ast_content"] if c["ast_shared"] else c["ast_style"]


def d_content(c):
    """Width of h_content."""
    return c["ast_content"]["d_out"] + c["d_text"]


def d_style(c):
    """Width of h_style."""
    return style_ast(c)["d_out"] + c["d_text"] + c["lstm_hidden"]


def output_row(c, columns):
    """Width of one row of output: `columns` of a frame, or of all frames of a segment."""
    return columns * (c["frames"] if c["granularity"] == "Segment" else 1)


def encoder_shapes(c):
    """Both encoders."""
    shapes = ast.ast_shapes(c["ast_content"], "ast_content.")
    if not c["ast_shared"]:
        shapes |= ast.ast_shapes(c["ast_style"], "ast_style.")
    return (shapes | layers.attention("content_attention", d_content(c))
            | layers.attention("style_attention", style_ast(c)["d_out"] + c["d_text"])
            | layers.lstm("pose_lstm", c["d_pose"], c["lstm_hidden"], c["lstm_layers"]))


def generator_shapes(c, prefix, embedding, columns):
    """The decoder behind Dense, with its output layer and the embedding of what it put out."""
    d, ff, row = c["d_model"], c["decoder_ff"], output_row(c, columns)
    shapes = {}
    if c["decoder_mode"] == "Autoregressive":
        shapes |= layers.linear(prefix + embedding, d, row)
    for n in range(c["decoder_layers"]):
        layer = f"{prefix}decoder.layers.{n}."
        shapes |= {
            **layers.attention(layer + "self_attn", d),
            **layers.attention(layer + "multihead_attn", d),
            **layers.linear(layer + "linear1", ff, d), **layers.linear(layer + "linear2", d, ff),
            **layers.norm(layer + "norm1", d), **layers.norm(layer + "norm2", d),
            **layers.norm(layer + "norm3", d),
        }
    return shapes | layers.linear(prefix + "head", row, d)


def default_asts(config):
    """The AST configurations that must be there, the style's like the content's."""
    config.setdefault("ast_content", {})
    if not config.get("ast_shared", False):
        config.setdefault("ast_style", config["ast_content"])
    return config


def pats_joints(d_pose):
    if d_pose != 2 * len(PATS_JOINTS):
        return []
    return [{"name": name, "parent": parent, "source": i}
            for i, (name, parent, _) in enumerate(PATS_JOINTS)]


def check_zs_mstm1(c, where="config"):
    positive(c, where, "frames", "d_text", "d_pose", "d_model", "attention_heads",
             "lstm_layers", "lstm_hidden", "decoder_layers", "decoder_heads", "decoder_ff",
             "context_segments")
    expect(c["ast_shared"] == ("ast_style" not in c), where, "ast_style",
           "present" if "ast_style" in c else "absent",
           "the opposite: it is there exactly when ast_shared is false")
    for name in ("ast_content", "ast_style"):
        if name in c:
            part = c[name]
            ast.check_ast(part, f"{where}.{name}")
            expect(part["frames"] == c["frames"], f"{where}.{name}", "frames", part["frames"],
                   f"{c['frames']} as in {where}.frames")
            divides(c, where, "attention_heads", f"{name}.d_out + d_text",
                    part["d_out"] + c["d_text"])
    if not c["ast_shared"]:
        bins = c["ast_content"]["mel_bins"]
        expect(c["ast_style"]["mel_bins"] == bins, f"{where}.ast_style", "mel_bins",
               c["ast_style"]["mel_bins"], f"{bins} as in ast_content")
    divides(c, where, "decoder_heads", "d_model", c["d_model"])
    if c["granularity"] == "Frame":
        expect(c["context_segments"] == 1, where, "context_segments", c["context_segments"],
               "1 with granularity Frame")


class ZsMstm1(Kind):
    config_type = "ZsMstm1Config"
    gains = GAINS
    tables = ast.TABLES

    def defaults(self, config):
        return default_asts(config)

    def check(self, config):
        check_zs_mstm1(config)

    def shapes(self, config):
        return (encoder_shapes(config)
                | layers.linear("dense", config["d_model"], d_content(config) + d_style(config))
                | generator_shapes(config, "", "pose_embedding", config["d_pose"]))

    def streams(self, config):
        return {"speech": config["ast_content"]["mel_bins"], "text": config["d_text"],
                "pose": config["d_pose"]}

    def inputs(self, config, streams, segments=1, style_segments=1):
        rows = config["frames"] * config["context_segments"] * segments
        style = config["frames"] * style_segments
        return {"speech": streams.rows("speech", rows), "text": streams.rows("text", rows),
                "style_speech": streams.rows("speech", style),
                "style_text": streams.rows("text", style),
                "style_pose": streams.rows("pose", style)}

    def demo(self):
        # POSE has the neck at 0, and the statistics of speech are of recordings at 16 kHz.
        return {"normalisations": [ast.SPEECH, POSE],
                "features": {"neck": "Zero", "sample_rate": 16000}}

    def joints(self, config):
        return pats_joints(config["d_pose"])

    def ast_parts(self, config):
        parts = [("ast_content.", config["ast_content"])]
        return parts if config["ast_shared"] else parts + [("ast_style.", config["ast_style"])]


KIND = ZsMstm1()
