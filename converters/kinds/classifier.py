"""Classifier C of transfer strength (thesis 7.5.1)."""

from .. import layers
from ..checks import positive
from ..kind import Kind


class Classifier(Kind):
    config_type = "ClassifierConfig"
    # Large enough for a strength that comes close to 0 and to 1 over the segments of a gesture.
    gains = {"weight_ih_l": 2.5, "weight_hh_l": 1.5, "dense.weight": 6.0}

    def check(self, config):
        positive(config, "config", "frames", "d_in", "layers", "hidden")

    def shapes(self, config):
        return {**layers.lstm("lstm", config["d_in"], config["hidden"], config["layers"]),
                **layers.linear("dense", 1, config["hidden"])}

    def streams(self, config):
        return {"motion": config["d_in"]}

    def inputs(self, config, streams, segments=2):
        return {"motion": streams.rows("motion", segments * config["frames"])}


KIND = Classifier()
