"""Model 1 (thesis 5.5.3, 5.5.4)."""

from .. import layers
from ..channels import check_channels, default_channels, tokens_of
from ..checks import positive
from ..kind import Kind
from .autoencoder import DECODER_HH, F0


class Model1(Kind):
    config_type = "Model1Config"
    # The encoders' last steps are small: what reads them must lift them over the biases.  Heads far
    # above one give the most probable token a clear lead.
    gains = {"d_face.*weight_hh": DECODER_HH, "weight_hh": 1.5, "d_face.*lstm1.weight_ih": 6.0,
             "e2_speech.lstm1.weight_ih": 6.0, "e_.*lstm2.weight_ih": 4.0, "weight_ih": 2.5,
             "heads": 12.0}

    def defaults(self, config):
        config.setdefault("channels", default_channels())
        return config

    def check(self, config):
        positive(config, "config", "f0_length", "d_text", "text_rows", "ae_hidden", "hidden1",
                 "hidden2", "out_length")
        check_channels(config)

    def shapes(self, config):
        ae, first, second = config["ae_hidden"], config["hidden1"], config["hidden2"]
        shapes = {**layers.bilstm("e1_speech.lstm1", 1, 2 * ae),
                  **layers.bilstm("e1_speech.lstm2", 4 * ae, ae)}
        for name, columns in (("e2_speech", 2 * ae), ("e_text", config["d_text"])):
            shapes |= layers.bilstm(name + ".lstm1", columns, first)
            shapes |= layers.bilstm(name + ".lstm2", 2 * first, second)
        for n, channel in enumerate(config["channels"]):
            shapes |= layers.lstm(f"d_face.{n}.lstm1", 4 * second, ae)
            shapes |= layers.lstm(f"d_face.{n}.lstm2", ae, 2 * ae)
            shapes |= layers.linear(f"heads.{n}", tokens_of(channel), 2 * ae)
        return shapes

    def streams(self, config):
        return {"f0": 1, "text": config["d_text"]}

    def inputs(self, config, streams, words=4):
        rows = config["text_rows"]
        text = streams.rows("text", words * rows)
        return {"f0": streams.contours(words, config["f0_length"], 80.0, 320.0),
                "text": text.reshape(words, rows, -1) if rows > 1 else text}

    def demo(self):
        return {"normalisations": [{"stream": "f0", **F0}]}


KIND = Model1()
