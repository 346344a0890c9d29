"""AE_speech and AE_face (thesis 5.5.1, 5.5.2)."""

import torch
from torch import nn

from .blocks import no_tap, normalisation_of, scoped
from .recurrent import Decoder, Encoder


class Network(nn.Module):
    """values (sequences, L) -> code and reconstruction (sequences, L); or one half of it."""

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        self.values = normalisation_of(network, "values")
        hidden, alpha = c["hidden"], c["alpha"]
        if c["part"] != "Decoder":
            self.encoder = Encoder(1, 2 * hidden, hidden, alpha, c["code"] == "Sequence")
        if c["part"] != "Encoder":
            self.decoder = Decoder(2 * hidden, hidden, alpha)
            self.decoder.dense = nn.Linear(2 * hidden, 1)
        self.output = "code" if c["part"] == "Encoder" else "reconstruction"

    def weights(self):
        return self

    def forward(self, arrays, tap=no_tap):
        outputs = {}
        if self.c["part"] == "Decoder":
            codes = arrays["code"].reshape(len(arrays["code"]), -1, 2 * self.c["hidden"])
        else:
            codes = torch.stack([self.encoder(self.values.apply(x[:, None]), scoped(tap, "encoder"))
                                 for x in arrays["values"]])
            outputs["code"] = codes if self.c["code"] == "Sequence" else codes[:, 0]
        if self.c["part"] != "Encoder":
            outputs["reconstruction"] = torch.stack(
                [self.decode(code, scoped(tap, "decoder")) for code in codes])
        return outputs

    def decode(self, code, tap):
        """A vector (1, 2H) stands at every step (RepeatVector)."""
        rows = self.decoder(code.expand(self.c["length"], -1), tap)
        return self.values.undo(self.decoder.dense(rows)[:, 0])
