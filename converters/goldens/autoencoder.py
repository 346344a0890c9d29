"""Cases of the autoencoders."""

from .case import Case

SMALL = {"length": 9, "hidden": 6}
VALUES = {"stream": "values", "mean": [150.0], "deviation": [40.0]}


def _case(name, about, changes, statistics=(VALUES,), **sizes):
    fields = {"config": {**SMALL, **changes}, "normalisations": list(statistics)}
    return Case(f"autoencoder_{name}", about, "autoencoder", fields, sizes=sizes)


CASES = [
    _case("vector", "autoencoder, all defaults: the last step is the code", {}, sequences=3),
    _case("sequence", "autoencoder, every step is code", {"code": "Sequence"}),
    _case("encoder", "its encoder alone", {"part": "Encoder", "alpha": 0.3}, sequences=3),
    _case("encoder_sequence", "its encoder alone, every step",
          {"part": "Encoder", "code": "Sequence"}, ()),
    _case("decoder", "its decoder alone", {"part": "Decoder", "alpha": 0.3}, sequences=3),
    _case("decoder_sequence", "its decoder alone, from every step",
          {"part": "Decoder", "code": "Sequence"}),
]
