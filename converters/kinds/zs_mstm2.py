"""ZS-MSTM 2.0 (thesis chapter 7): 1.0 with a face and dialog acts beside the body."""

import numpy as np

from .. import layers
from ..checks import positive
from ..kind import Kind
from . import ast, zs_mstm1
from .bert import DIALOG_ACTS

# Fifteen of OpenPose's face points (features.md, section 6), at rest in the units of PATS_JOINTS.
FACE_POINTS = (
    (0, (-62, -160)), (4, (-46, -98)), (8, (0, -72)), (12, (46, -98)), (16, (62, -160)),
    (17, (-48, -182)), (19, (-32, -190)), (21, (-12, -184)),
    (22, (12, -184)), (24, (32, -190)), (26, (48, -182)),
    (37, (-30, -170)), (41, (-30, -161)), (44, (30, -170)), (46, (30, -161)),
)
FACE = {"stream": "face", "mean": np.array([at for _, at in FACE_POINTS], float).T.ravel().tolist(),
        "deviation": [4.0] * 2 * len(FACE_POINTS)}


def d_style(c):
    """Width of h_style: eq. 7.1."""
    return zs_mstm1.d_style(c["core"]) + c["core"]["lstm_hidden"] + c["d_tags"]


class ZsMstm2(Kind):
    config_type = "ZsMstm2Config"
    gains = {**zs_mstm1.GAINS, "generator.embedding.weight": 0.5}
    tables = ast.TABLES

    def defaults(self, config):
        """Table 7.1, where it differs from chapter 6."""
        core = {"frames": 16, "d_model": 64, "lstm_hidden": 64, **config.get("core", {})}
        part = {"frames": core["frames"], "head": "LayerNormLinear", "d_out": 64}
        for name in ("ast_content", "ast_style"):
            if name in core:
                core[name] = {**part, **core[name]}
        core.setdefault("ast_content", part)
        return {**config, "core": zs_mstm1.default_asts(core)}

    def check(self, config):
        positive(config, "config", "d_face", "d_tags")
        zs_mstm1.check_zs_mstm1(config["core"], "config.core")

    def shapes(self, config):
        core = config["core"]
        d, width = core["d_model"], zs_mstm1.d_content(core) + d_style(config)
        shapes = zs_mstm1.encoder_shapes(core) | layers.lstm(
            "face_lstm", config["d_face"], core["lstm_hidden"], core["lstm_layers"])
        if config["dense_shared"]:
            shapes |= layers.linear("dense", d, width)
        for prefix, columns in (("pose_generator.", core["d_pose"]),
                                ("face_generator.", config["d_face"])):
            if not config["dense_shared"]:
                shapes |= layers.linear(prefix + "dense", d, width)
            shapes |= zs_mstm1.generator_shapes(core, prefix, "embedding", columns)
        return shapes

    def streams(self, config):
        return {**zs_mstm1.KIND.streams(config["core"]), "face": config["d_face"]}

    def inputs(self, config, streams, segments=1, style_segments=1):
        core = config["core"]
        inputs = zs_mstm1.KIND.inputs(core, streams, segments, style_segments)
        inputs["style_face"] = streams.rows("face", core["frames"] * style_segments)
        # A segment holds one dialog act, or a few.
        tags = streams.rng.random((style_segments, config["d_tags"]))
        held = (tags < 0.1) | (tags == tags.min(1, keepdims=True))
        inputs["style_tags"] = held.astype("float32")
        return inputs

    def demo(self):
        demo = zs_mstm1.KIND.demo()
        return {**demo, "normalisations": [*demo["normalisations"], FACE]}

    def joints(self, config):
        return zs_mstm1.pats_joints(config["core"]["d_pose"])

    def features(self, config):
        features = {}
        if config["d_face"] == 2 * len(FACE_POINTS):
            features["landmarks"] = [{"name": f"face{i}", "source": i} for i, _ in FACE_POINTS]
        if config["d_tags"] == len(DIALOG_ACTS):
            features["tags"] = list(DIALOG_ACTS)
        return features

    def ast_parts(self, config):
        return zs_mstm1.KIND.ast_parts(config["core"])


KIND = ZsMstm2()
