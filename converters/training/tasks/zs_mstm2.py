"""ZS-MSTM 2.0: 1.0 with faces and dialog acts (thesis 7.3 and 7.4)."""

from ...kinds import zs_mstm2
from . import zs_mstm1


class Task(zs_mstm1.Task):
    kind = "zs_mstm2"
    streams = ("speech", "text", "pose", "face", "tags")
    options = zs_mstm1.Task.options

    def core_of(self, config):
        return config["core"]

    def d_style(self, config):
        return zs_mstm2.d_style(config)

    def with_widths(self, config):
        return {**config, "core": super().with_widths(dict(config.get("core", {})))}

    def places_of(self, key):
        """Both decoders begin as that of 1.0, which knows when to move."""
        if key.split(".")[0] in ("dense", "decoder", "head", "embedding"):
            return [f"{stream}_generator.{key}" for stream in ("pose", "face")] + [key]
        return [key]
