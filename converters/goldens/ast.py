"""Cases of AST."""

from .case import Case

SMALL = {"frames": 8, "mel_bins": 16, "patch": 4, "stride": 3, "d_model": 16, "layers": 2,
       "heads": 2, "d_mlp": 24, "d_out": 16}
SPEECH = {"stream": "speech", "mean": [-7.5], "deviation": [3.25]}

CASES = [
    Case("ast_cls", "AST alone, [CLS]", "ast", {"config": SMALL, "normalisations": [SPEECH]}),
    Case("ast_mean_head", "AST alone, mean of both tokens, LayerNorm and Linear", "ast",
         {"config": {**SMALL, "pool": "MeanClsDist", "head": "LayerNormLinear", "d_out": 5}}),
]
