"""Model 2 (thesis 5.6.1, 5.6.2)."""

from .. import layers
from ..channels import check_channels, default_channels, tokens_of
from ..checks import divides, expect, positive
from ..kind import Kind


def stacks(channels):
    """The first channel of every decoder stack, in the order of the stacks."""
    first = {}
    for channel in channels:
        first.setdefault(channel["stack"], channel)
    return [first[stack] for stack in sorted(first)]


def adds_text(c):
    """Whether H_att is as wide as X_text and X_text is added to it."""
    return c["attention_width"] != c["d_model"]


class Model2(Kind):
    config_type = "Model2Config"
    # Scores of attention have no 1 / sqrt(width) by default: elsewhere than in the decoders they
    # stay small.  What the sub-layers of decoders add is small beside the embedding of the last
    # token, or sequences would soon repeat one token; heads give the most probable a clear lead.
    gains = {"decoders.*(attn.out|linear2)": 0.3, "decoders.*query": 2.0, "query|key": 0.7,
             "conv": 1.4, "heads": 4.0}
    tables = {"embedding": 0.3}

    def defaults(self, config):
        config.setdefault("channels", default_channels())
        return config

    def check(self, config):
        c = config
        positive(c, "config", "max_words", "f0_length", "d_text", "d_model", "convolutions",
                 "encoder_layers", "encoder_heads", "encoder_ff", "attention_heads", "attention_ff",
                 "decoder_layers", "decoder_heads", "decoder_ff", "max_out", "kernel")
        expect(c["f0_tokens"] >= 2, "config", "f0_tokens", c["f0_tokens"], "at least 2")
        expect(c["f0_step"] > 0, "config", "f0_step", c["f0_step"], "above zero")
        expect(c["kernel"] % 2 == 1, "config", "kernel", c["kernel"], "an odd number")
        for name in ("encoder_heads", "attention_heads", "decoder_heads"):
            divides(c, "config", name, "d_model", c["d_model"])
        widths = {c["d_model"]} if c["master"] == "Speech" else {c["d_model"], c["d_text"]}
        expect(c["attention_width"] in widths, "config", "attention_width", c["attention_width"],
               f"d_model {c['d_model']}"
               + (f" or d_text {c['d_text']}" if c["master"] == "Text" else " with master Speech"))
        check_channels(c)
        self._check_stacks(c["channels"])

    def _check_stacks(self, channels):
        for number, first in enumerate(stacks(channels)):
            expect(first["stack"] == number, f"config.channels.{first['name']}", "stack",
                   first["stack"], f"{number}: stacks are numbered from 0 without gaps")
        for channel in channels:
            levels = stacks(channels)[channel["stack"]]["levels"]
            expect(channel["levels"] == levels, f"config.channels.{channel['name']}", "levels",
                   channel["levels"], f"{levels} as the others of stack {channel['stack']}")

    def shapes(self, config):
        c, d = config, config["d_model"]
        shapes = {"f0_encoder.embedding.weight": (c["f0_tokens"], d)}
        shapes |= self._convolutions("f0_encoder.conv", c, d)
        for n in range(c["encoder_layers"]):
            shapes |= _layer(f"encoder.layers.{n}", d, c["encoder_ff"])
        if c["master"] == "Text":
            shapes |= layers.linear("cross.text_projection", d, c["d_text"])
        slave = d if c["master"] == "Text" else c["d_text"]
        shapes |= _layer("cross.layer", d, c["attention_ff"], slave, c["shared_norm"])
        if adds_text(c):
            shapes |= layers.linear("cross.output", c["d_text"], d)
        for s, channel in enumerate(stacks(c["channels"])):
            shapes[f"decoders.{s}.embedding.weight"] = (tokens_of(channel), d)
            for n in range(c["decoder_layers"]):
                shapes |= _layer(f"decoders.{s}.layers.{n}", d, c["decoder_ff"],
                                 c["attention_width"], c["shared_norm"])
        if c["conv_decoder"]:
            shapes |= self._convolutions("conv_decoder", c, len(c["channels"]) * d)
        for n, channel in enumerate(c["channels"]):
            shapes |= layers.linear(f"heads.{n}", tokens_of(channel), d)
        return shapes

    def _convolutions(self, prefix, c, columns):
        shapes = {}
        for n in range(c["convolutions"]):
            shapes |= layers.conv1d(f"{prefix}.{n}", c["d_model"], columns if n == 0
                                    else c["d_model"], c["kernel"])
        return shapes

    def streams(self, config):
        return {"text": config["d_text"]}

    def inputs(self, config, streams, words=None):
        words = words or config["max_words"]
        # Somewhat wider than the range of tokens at its upper end, which clamps.
        span = config["f0_step"] * config["f0_tokens"]
        low, high = config["f0_minimum"] + 0.1 * span, config["f0_minimum"] + 1.05 * span
        return {"f0": streams.contours(words, config["f0_length"], low, high),
                "text": streams.rows("text", words)}


def _layer(key, d, ff, memory=None, shared_norm=False):
    """One Transformer layer; with `memory` (its columns) it has a sub-layer that looks there."""
    shapes = {**_attention(f"{key}.self_attn", d, d), **layers.norm(f"{key}.norm1", d)}
    if memory is not None:
        shapes |= _attention(f"{key}.cross_attn", d, memory)
        if not shared_norm:
            shapes |= layers.norm(f"{key}.norm2", d)
    shapes |= {**layers.linear(f"{key}.linear1", ff, d), **layers.linear(f"{key}.linear2", d, ff)}
    return shapes | layers.norm(f"{key}.norm2" if memory is None else f"{key}.norm3", d)


def _attention(key, d, memory):
    return {**layers.linear(f"{key}.query", d, d), **layers.linear(f"{key}.key", d, memory),
            **layers.linear(f"{key}.value", d, memory), **layers.linear(f"{key}.out", d, d)}


KIND = Model2()
