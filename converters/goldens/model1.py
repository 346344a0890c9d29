"""Cases of Model 1."""

from .case import Case

CHANNELS = [{"name": "AU01", "unit": "intensity 0 to 5", "step": 0.5, "levels": 8},
            {"name": "AU04", "unit": "intensity 0 to 5", "step": 0.25, "levels": 11},
            {"name": "Rx", "unit": "rad", "minimum": -0.3, "step": 0.1, "levels": 6}]
SMALL = {"f0_length": 7, "d_text": 5, "ae_hidden": 4, "hidden1": 5, "hidden2": 3, "out_length": 9,
         "channels": CHANNELS}
F0 = {"stream": "f0", "mean": [150.0], "deviation": [60.0]}
TEXT = {"stream": "text", "mean": [0.1, 0.2, 0.3, 0.4, 0.5], "deviation": [1, 2, 1, 2, 0.5],
        "divisor": 1.0}


def _case(name, about, changes, statistics=(F0,), words=5):
    fields = {"config": {**SMALL, **changes}, "normalisations": list(statistics)}
    return Case(f"model1_{name}", about, "model1", fields, sizes={"words": words})


CASES = [
    _case("vector", "Model 1, all defaults: E1 hands over a vector", {}),
    _case("sequence", "Model 1, E1 hands over every step", {"code": "Sequence"}, (F0, TEXT)),
    _case("text_rows", "Model 1, three rows of text a word, slopes of its own",
          {"text_rows": 3, "alpha": 0.2, "ae_alpha": 0.1}, (F0, TEXT), 3),
    _case("half", "Model 1, h as wide as the code that D_face was trained on",
          {"hidden2": 2, "hidden1": 6, "channels": CHANNELS[1:]}, (F0, TEXT)),
]
