"""Writes the goldens of the C++ tests: tiny networks, their inputs and what PyTorch makes of them.

`/usr/bin/python3 -m converters.goldens` from the root of the repository.  One weights file and one
.npz a case; every alternative reading of ZS-MSTM 1.0 that the schema has appears in some case.
"""

import os
import platform
import sys

import numpy as np

from . import VERSION, networks, weights_file
from .export import make_self_test
from .random_weights import random_weights

SEED = 20231

AST = {"frames": 8, "mel_bins": 16, "patch": 4, "stride": 3, "d_model": 16, "layers": 2,
       "heads": 2, "d_mlp": 24, "d_out": 16}
SMALL = {"frames": 8, "d_text": 12, "d_pose": 6, "d_model": 16, "ast_content": AST,
         "ast_shared": True, "lstm_layers": 2, "lstm_hidden": 8, "decoder_ff": 20}
JOINTS = [{"name": "Neck", "parent": -1, "source": 0},
          {"name": "RShoulder", "parent": 0, "source": 1},
          {"name": "RElbow", "parent": 1, "source": 2}]
SPEECH = {"stream": "speech", "mean": [-7.5], "deviation": [3.25]}
TEXT = {"stream": "text", "mean": [0.1 * i for i in range(12)],
        "deviation": [0.5 + 0.05 * i for i in range(12)], "divisor": 1.0}
POSE = {"stream": "pose", "mean": [0, -150, -200, 0, 20, 230],
        "deviation": [4, 10, 40, 4, 12, 50]}

# case -> (what it is about, changes to SMALL, normalisations, style segments, windows of speech)
ZS_MSTM1_CASES = {
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
AST_CASES = {
    "ast_cls": ("AST alone, [CLS]", {}, [SPEECH]),
    "ast_mean_head": ("AST alone, mean of both tokens, LayerNorm and Linear",
                      {"pool": "MeanClsDist", "head": "LayerNormLinear", "d_out": 5}, None),
}


def cases():
    """name, description, completed network, style segments, windows of speech."""
    for name, (about, changes, statistics, style, windows) in ZS_MSTM1_CASES.items():
        network = {"config": {**SMALL, **changes}}
        if statistics is not None:
            network |= {"normalisations": statistics, "joints": JOINTS}
        yield name, about, networks.complete("zs_mstm1", network), style, windows
    for name, (about, changes, statistics) in AST_CASES.items():
        network = {"config": {**AST, **changes}}
        if statistics is not None:
            network["normalisations"] = statistics
        yield name, about, networks.complete("ast", network), 1, 1


def make_case(folder, name, about, network, style_segments, windows):
    from .reference.run import build, run
    weights = random_weights(network, SEED)
    module = build(network, weights)
    inputs = networks.random_inputs(network, SEED, windows, style_segments)
    single = style_segments == windows == 1
    expected = run(module, inputs, taps=True)
    if not single:  # a tap of several runs has no single value
        repeated = ("tap/style",) * (style_segments > 1)
        repeated += ("tap/content", "tap/generator") * (windows > 1)
        expected = {key: x for key, x in expected.items() if not key.startswith(repeated or "-")}
    tensors = dict(weights)
    if "normalisations" in network or network["config_type"] == "AstConfig":
        tensors |= make_self_test(network, module, SEED + 1)
    provenance = {"trained": False, "recipe": f"golden {name} ({about}), random, seed {SEED}",
                  "licence": "as gestus", "converter": f"gestus converters {VERSION}"}
    weights_file.write(os.path.join(folder, name + ".fb"), [network], tensors, provenance)
    write_npz(os.path.join(folder, name + ".npz"), inputs | expected)


def write_npz(path, arrays):
    """np.savez, whose members carry no time of day: the same arrays give the same bytes."""
    with open(path, "wb") as file:
        np.savez(file, **arrays)


def main(folder="tests/goldens"):
    import torch
    os.makedirs(folder, exist_ok=True)
    lines = []
    for name, about, *case in cases():
        make_case(folder, name, about, *case)
        lines.append(f"| {name} | {about} |")
    readme = README.format(seed=SEED, python=platform.python_version(), numpy=np.__version__,
                           torch=torch.__version__, table="\n".join(lines))
    with open(os.path.join(folder, "README.md"), "w", encoding="utf-8") as file:
        file.write(readme)


README = """# Goldens

Tiny networks with random weights, their inputs, and what PyTorch's reference (converters/reference,
in double precision) makes of them, layer by layer.  The C++ tests read them; they need no PyTorch.

`<case>.fb` is the weights file.  `<case>.npz` holds, float32, the inputs and the outputs under the
names that infer-cli gives them, and intermediates as `tap/<name>`; those that several segments
would share are left out.

Made by `/usr/bin/python3 -m converters.goldens`, seed {seed}, Python {python}, NumPy {numpy},
PyTorch {torch}.  Running it again gives the same bytes.

| case | about |
|---|---|
{table}
"""

if __name__ == "__main__":
    main(*sys.argv[1:])
