"""Cases of the classifier of transfer strength."""

from .case import Case

SMALL = {"frames": 5, "d_in": 6, "layers": 3, "hidden": 7}
MOTION = {"stream": "motion", "mean": [0, -150, -200, 0, 20, 230],
          "deviation": [4, 10, 40, 4, 12, 50]}

CASES = [
    Case("classifier_three_layers", "classifier of transfer strength", "classifier",
         {"config": SMALL, "normalisations": [MOTION]}, sizes={"segments": 4}),
    Case("classifier_one_layer", "one layer, no statistics", "classifier",
         {"config": {**SMALL, "layers": 1, "frames": 1}}, sizes={"segments": 3}),
]
