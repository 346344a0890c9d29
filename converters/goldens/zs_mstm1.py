"""Cases of ZS-MSTM 1.0."""

from .ast import SMALL as AST
from .ast import SPEECH
from .case import Case

SMALL = {"frames": 8, "d_text": 12, "d_pose": 6, "d_model": 16, "ast_content": AST,
         "ast_shared": True, "lstm_layers": 2, "lstm_hidden": 8, "decoder_ff": 20}
JOINTS = [{"name": "Neck", "parent": -1, "source": 0},
          {"name": "RShoulder", "parent": 0, "source": 1},
          {"name": "RElbow", "parent": 1, "source": 2}]
TEXT = {"stream": "text", "mean": [0.1 * i for i in range(12)],
        "deviation": [0.5 + 0.05 * i for i in range(12)], "divisor": 1.0}
POSE = {"stream": "pose", "mean": [0, -150, -200, 0, 20, 230],
        "deviation": [4, 10, 40, 4, 12, 50]}

# case -> (what it is about, changes to SMALL, normalisations, style segments, windows of speech)
_READINGS = {
    "frame_autoregressive": ("all defaults", {}, [SPEECH, POSE], 1, 1),
    "no_normalisation": ("no statistics, joints or self-test", {}, None, 1, 1),
    "text_normalisation": ("per-column text statistics, divisor 1", {}, [SPEECH, TEXT, POSE], 1, 1),
    "ast_separate": ("two ASTs of different geometry",
                     {"ast_shared": False,
                      "ast_style": {**AST, "heads": 4, "layers": 1, "d_mlp": 16}},
                     [SPEECH, POSE], 1, 1),
    "ast_pool_mean": ("mean of [CLS] and distillation token",
                      {"ast_content": {**AST, "pool": "MeanClsDist"}}, [SPEECH, POSE], 1, 1),
    "ast_head_norm_linear": ("LayerNorm and Linear after AST's pooling",
                             {"ast_content": {**AST, "head": "LayerNormLinear", "d_out": 8}},
                             [SPEECH, POSE], 1, 1),
    "ast_head_linear": ("Linear after AST's pooling",
                        {"ast_content": {**AST, "head": "Linear", "d_out": 20}},
                        [SPEECH, POSE], 1, 1),
    "style_first": ("first row of the style attention", {"style_pool": "First"}, [SPEECH, POSE],
                    1, 1),
    "style_last": ("last row of the style attention", {"style_pool": "Last"}, [SPEECH, POSE], 1, 1),
    "style_two_segments": ("style clip of two segments", {}, [SPEECH, POSE], 2, 1),
    "speech_two_segments": ("speech of two segments", {}, [SPEECH, POSE], 1, 2),
    "shifted_parallel": ("z one row later as target", {"decoder_mode": "ShiftedParallel"},
                         [SPEECH, POSE], 1, 1),
    "parallel": ("z as target", {"decoder_mode": "Parallel"}, [SPEECH, POSE], 1, 1),
    "no_positions": ("no positions, autoregressive", {"positions": "None"}, [SPEECH, POSE], 1, 1),
    "parallel_no_positions": ("no positions, parallel",
                              {"positions": "None", "decoder_mode": "Parallel"},
                              [SPEECH, POSE], 1, 1),
    "decoder_two_layers": ("two decoder layers, autoregressive", {"decoder_layers": 2},
                           [SPEECH, POSE], 1, 1),
    "parallel_two_layers": ("two decoder layers, shifted",
                            {"decoder_layers": 2, "decoder_mode": "ShiftedParallel"},
                            [SPEECH, POSE], 1, 1),
    "lstm_three_layers": ("three LSTM layers, epsilons and heads of their own",
                          {"lstm_layers": 3, "decoder_ln_eps": 1e-3, "decoder_heads": 4,
                           "attention_heads": 2,
                           "ast_content": {**AST, "ln_eps": 1e-12, "heads": 1}},
                          [SPEECH, POSE], 1, 1),
    "segment_one": ("segment granularity, each segment alone", {"granularity": "Segment"},
                    [SPEECH, POSE], 1, 1),
    "segment_three": ("segment granularity, three segments see one another",
                      {"granularity": "Segment", "context_segments": 3}, [SPEECH, TEXT, POSE],
                      2, 1),
    "segment_three_shifted": ("the same, shifted", {"granularity": "Segment",
                              "context_segments": 3, "decoder_mode": "ShiftedParallel"},
                              [SPEECH, POSE], 1, 1),
    "segment_three_parallel": ("the same, parallel", {"granularity": "Segment",
                               "context_segments": 3, "decoder_mode": "Parallel",
                               "positions": "None", "decoder_layers": 2}, [SPEECH, POSE], 1, 2),
}


def _case(name, about, changes, statistics, style_segments, windows):
    network = {"config": {**SMALL, **changes}}
    if statistics is not None:
        network |= {"normalisations": statistics, "joints": JOINTS}
    # What several segments share a name for has no single value.
    shared = ("tap/style",) * (style_segments > 1)
    shared += ("tap/content", "tap/generator") * (windows > 1)
    return Case(name, about, "zs_mstm1", network,
                sizes={"segments": windows, "style_segments": style_segments}, untapped=shared,
                self_test=statistics is not None)


CASES = [_case(name, *reading) for name, reading in _READINGS.items()]
