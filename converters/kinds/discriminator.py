"""Discriminator Dis (thesis 6.5.4): regression of h_style from h_content."""

from .. import layers
from ..checks import positive
from ..kind import Kind


class Discriminator(Kind):
    config_type = "DiscriminatorConfig"

    def check(self, config):
        positive(config, "config", "rows", "d_content", "d_style")
        if config["layers"]:
            positive(config, "config", "hidden")

    def shapes(self, config):
        columns, shapes = config["d_content"], {}
        for n in range(config["layers"]):
            shapes |= layers.linear(f"layers.{n}", config["hidden"], columns)
            columns = config["hidden"]
        return shapes | layers.linear("output", config["d_style"], columns)

    def inputs(self, config, streams, segments=1):
        content = streams.smooth(segments * config["rows"], config["d_content"])
        return {"content": content.astype("float32")}


KIND = Discriminator()
