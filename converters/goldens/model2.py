"""Cases of Model 2."""

from .case import Case

CHANNELS = [{"name": "AU01", "unit": "intensity 0 to 5", "step": 0.25, "levels": 17, "stack": 0},
            {"name": "AU04", "unit": "intensity 0 to 5", "step": 0.25, "levels": 17, "stack": 1},
            {"name": "Rx", "unit": "rad", "minimum": -0.3, "step": 0.05, "levels": 13, "stack": 2}]
# As released: one stack for all action units, one for each rotation.
SHARED = [{**channel, "stack": stack} for channel, stack in zip(CHANNELS, (0, 0, 1))]
SMALL = {"max_words": 3, "f0_length": 5, "f0_step": 25.0, "f0_tokens": 12, "d_text": 6,
         "d_model": 8, "encoder_layers": 1, "encoder_heads": 2, "encoder_ff": 12,
         "attention_heads": 2, "attention_ff": 10, "attention_width": 8, "decoder_layers": 1,
         "decoder_heads": 2, "decoder_ff": 12, "max_out": 9, "channels": CHANNELS}
TEXT = {"stream": "text", "mean": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], "deviation": [1, 2, 1, 2, 0.5, 1],
        "divisor": 1.0}


def _case(name, about, changes, words=3, statistics=(), **options):
    fields = {"config": {**SMALL, **changes}, "normalisations": list(statistics)}
    return Case(f"model2_{name}", about, "model2", fields, sizes={"words": words}, options=options)


CASES = [
    _case("text", "Model 2, all defaults: text asks, a stack for each channel", {}),
    _case("wide", "Model 2, X_text is added to an H_att of its width",
          {"attention_width": 6, "encoder_layers": 2}, 3, [TEXT]),
    _case("speech", "Model 2, speech asks", {"master": "Speech"}, 3, [TEXT]),
    _case("scaled", "Model 2, scores over the root of the width, two decoder layers",
          {"scale": "Rsqrt", "decoder_layers": 2, "encoder_heads": 1, "attention_heads": 4}),
    _case("no_convolutions", "Model 2 without D1_face", {"conv_decoder": False}),
    _case("shared_norm", "Model 2, one norm for two sub-layers", {"shared_norm": True,
                                                                  "ln_eps": 1e-3}),
    _case("shared_stack", "Model 2, action units share a stack", {"channels": SHARED}),
    _case("released", "Model 2 as released: speech asks, shared stack and norm, no D1_face",
          {"master": "Speech", "shared_norm": True, "channels": SHARED, "conv_decoder": False}),
    _case("long", "Model 2, more words than one inter-pausal unit, a last unit that is not full",
          {"convolutions": 1, "kernel": 5}, 7, [TEXT]),
    _case("one_word", "Model 2, a single word", {"convolutions": 2}, 1),
    _case("drawn", "Model 2, tokens are drawn", {}, 4, (), temperature=1.5, seed=7),
    _case("drawn_top", "Model 2, tokens are drawn from the three most probable",
          {"channels": SHARED, "conv_decoder": False}, 4, (), temperature=2.5, top_k=3, seed=11),
]
