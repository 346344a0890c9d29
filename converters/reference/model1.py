"""Model 1 (thesis 5.5.3, 5.5.4)."""

import torch
from torch import nn

from ..channels import tokens_of
from .blocks import no_tap, normalisation_of
from .recurrent import Decoder, Encoder
from .tokens import face_of, lengths_of, most_probable


class Network(nn.Module):
    """f0 (words, f0_length), text (words, [text_rows,] d_text) -> tokens and face (words,
    out_length, channels), and lengths (words, channels) of the sequences."""

    output = "face"

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        self.f0, self.text = (normalisation_of(network, stream) for stream in ("f0", "text"))
        ae, layers = c["ae_hidden"], (c["hidden1"], c["hidden2"], c["alpha"], False)
        self.e1_speech = Encoder(1, 2 * ae, ae, c["ae_alpha"], c["code"] == "Sequence")
        self.e2_speech = Encoder(2 * ae, *layers)
        self.e_text = Encoder(c["d_text"], *layers)
        self.d_face = nn.ModuleList(Decoder(4 * c["hidden2"], ae, c["ae_alpha"])
                                    for _ in c["channels"])
        self.heads = nn.ModuleList(nn.Linear(2 * ae, tokens_of(channel))
                                   for channel in c["channels"])

    def weights(self):
        return self

    def forward(self, arrays, tap=no_tap):
        words = zip(arrays["f0"], arrays["text"].reshape(len(arrays["f0"]), -1, self.c["d_text"]))
        tokens = [self.word(f0, text, tap) for f0, text in words]
        return {"tokens": torch.stack(tokens),
                "face": face_of(torch.stack(tokens), self.c["channels"]),
                "lengths": torch.stack([lengths_of(t) for t in tokens])}

    def word(self, f0, text, tap):
        """(f0_length,), (text_rows, d_text) -> (out_length, channels)."""
        x = self.e1_speech(self.f0.apply(f0[:, None]))
        tap("e1_speech", x)
        h_speech = self.e2_speech(x.expand(len(f0), -1))  # a vector stands at every step
        tap("h_speech", h_speech)
        h_text = self.e_text(self.text.apply(text))
        tap("h_text", h_text)
        h = torch.cat([h_speech, h_text], 1).expand(self.c["out_length"], -1)  # eq. 5.4
        tokens = []
        for n, (d_face, head) in enumerate(zip(self.d_face, self.heads)):
            z = d_face(h)  # eq. 5.5 and 5.6
            tap(f"d_face.{n}", z)
            probabilities = head(z).softmax(-1)
            tap(f"probabilities.{n}", probabilities)
            tokens.append(most_probable(probabilities))
        return torch.stack(tokens, 1)
