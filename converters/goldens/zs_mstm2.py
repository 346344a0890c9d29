"""Cases of ZS-MSTM 2.0."""

from .ast import SPEECH
from .case import Case
from .zs_mstm1 import JOINTS, POSE

AST = {"frames": 8, "mel_bins": 10, "patch": 4, "stride": 3, "d_model": 8, "layers": 1, "heads": 2,
       "d_mlp": 12, "d_out": 6}
CORE = {"frames": 8, "d_text": 6, "d_pose": 6, "d_model": 8, "ast_content": AST,
        "ast_shared": True, "attention_heads": 2, "lstm_layers": 2, "lstm_hidden": 5,
        "decoder_ff": 12}
FACE = {"stream": "face", "mean": [10, -10, 0, 30], "deviation": [2, 3, 4, 5]}
TEXT = {"stream": "text", "mean": [0.2], "deviation": [0.7], "divisor": 1.0}


def _case(name, about, core, changes=None, windows=1, style_segments=1):
    fields = {"config": {"core": {**CORE, **core}, "d_face": 4, "d_tags": 5, **(changes or {})},
              "joints": JOINTS, "normalisations": [SPEECH, TEXT, POSE, FACE]}
    # What several segments share a name for has no single value.
    shared = ("tap/style",) * (style_segments > 1)
    shared += ("tap/content", "tap/pose_", "tap/face_") * (windows > 1)
    return Case(f"zs_mstm2_{name}", about, "zs_mstm2", fields,
                sizes={"segments": windows, "style_segments": style_segments}, untapped=shared)


CASES = [
    _case("autoregressive", "ZS-MSTM 2.0, all defaults", {}),
    _case("shifted", "shifted, one Dense for both decoders", {"decoder_mode": "ShiftedParallel"},
          {"dense_shared": True}),
    _case("parallel", "parallel, no positions, two decoder layers",
          {"decoder_mode": "Parallel", "positions": "None", "decoder_layers": 2}),
    _case("dense_shared", "autoregressive, one Dense for both decoders", {},
          {"dense_shared": True}),
    _case("ast_separate", "two ASTs, other pooling and head",
          {"ast_shared": False, "style_pool": "First",
           "ast_style": {**AST, "head": "None", "d_out": 8, "pool": "MeanClsDist"}}),
    _case("style_last", "last row of the style attention", {"style_pool": "Last"}),
    _case("two_segments", "speech and style clip of two segments", {}, None, 2, 2),
    _case("segment", "segment granularity, two segments see one another",
          {"granularity": "Segment", "context_segments": 2}, {"d_face": 4}, 1, 2),
]
