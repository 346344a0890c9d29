"""The networks that are compared: those of the thesis, and the parts that decide their speed."""

from typing import NamedTuple


class Case(NamedTuple):
    name: str     # of its folder
    title: str    # one line for the page
    kind: str     # converters/kinds
    config: dict  # fields of its configuration that are not the default
    part: str     # class of modules.py; networks.cc declares the same by the kind
    size: int     # frames, tokens, steps or words of the input


CASES = (
    Case("ast64", "AST base, 64 frames, 62 tokens", "ast", {}, "Ast", 64),
    Case("ast1024", "AST base, 1024 frames, 1214 tokens", "ast", {"frames": 1024}, "Ast", 1024),
    Case("bert", "BERT base, 32 tokens", "bert", {}, "Bert", 32),
    Case("lstm768", "LSTM 3 x 768, 64 steps", "classifier", {"d_in": 22, "hidden": 768}, "Lstm", 64),
    Case("lstm64", "LSTM 3 x 64, 16 steps", "classifier", {"d_in": 64, "hidden": 64}, "Lstm", 16),
    Case("bilstm", "BiLSTM 200 + 100, input 768, 20 steps", "model1", {}, "BiLstm", 20),
    Case("generator", "ZS-MSTM 1.0 generator, 64 frames, one pass", "zs_mstm1",
         {"decoder_mode": "Parallel"}, "Generator", 64),
    # One decoder layer a channel, as in the released code.
    Case("model2", "Model 2, 100 positions, 32 words, nine decoders, one pass", "model2",
         {"max_words": 1, "max_out": 100, "decoder_layers": 1}, "Model2", 32),
)
