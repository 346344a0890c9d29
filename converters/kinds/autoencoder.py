"""AE_speech and AE_face (thesis 5.5.1, 5.5.2)."""

from .. import layers
from ..checks import positive
from ..kind import Kind

# f0 of read speech in Hz, with the zeros of short words.
F0 = {"mean": [120.0], "deviation": [70.0]}


# Recurrent gain of random decoders that read the same vector at every step: with less they soon
# stand still, with more they are chaotic and float32 loses the track of float64.
DECODER_HH = 2.0


class Autoencoder(Kind):
    config_type = "AutoencoderConfig"
    gains = {"decoder.*weight_hh": DECODER_HH, "weight_hh": 1.5, "weight_ih": 2.5, "dense": 2.0}

    def check(self, config):
        positive(config, "config", "length", "hidden")

    def shapes(self, config):
        hidden, shapes = config["hidden"], {}
        if config["part"] != "Decoder":
            shapes |= {**layers.bilstm("encoder.lstm1", 1, 2 * hidden),
                       **layers.bilstm("encoder.lstm2", 4 * hidden, hidden)}
        if config["part"] != "Encoder":
            shapes |= {**layers.lstm("decoder.lstm1", 2 * hidden, hidden),
                       **layers.lstm("decoder.lstm2", hidden, 2 * hidden),
                       **layers.linear("decoder.dense", 1, 2 * hidden)}
        return shapes

    def streams(self, _config):
        return {"values": 1}

    def inputs(self, config, streams, sequences=2):
        length, width = config["length"], 2 * config["hidden"]
        if config["part"] != "Decoder":
            values = streams.named("values", streams.smooth(length, sequences))
            return {"values": values.T.copy()}
        # What LSTM and LeakyReLU put out: numbers around zero, well below one.
        steps = (length,) if config["code"] == "Sequence" else ()
        code = 0.5 * streams.rng.standard_normal((sequences, *steps, width))
        return {"code": code.astype("float32")}

    def demo(self):
        return {"normalisations": [{"stream": "values", **F0}]}


KIND = Autoencoder()
