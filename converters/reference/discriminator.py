"""Discriminator Dis (thesis 6.5.4), as in fader networks (Lample et al. 2017)."""

import torch
from torch import nn
from torch.nn import functional as F

from .blocks import no_tap


class Network(nn.Module):
    """content (segments * rows, d_content) -> style (segments, d_style)."""

    output = "style"

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        widths = [c["d_content"]] + [c["hidden"]] * c["layers"]
        self.layers = nn.ModuleList(nn.Linear(*pair) for pair in zip(widths, widths[1:]))
        self.output_layer = nn.Linear(widths[-1], c["d_style"])

    def weights(self):
        return nn.ModuleDict({"layers": self.layers, "output": self.output_layer})

    def forward(self, arrays, tap=no_tap):
        return {"style": torch.cat([self.style(content, tap)
                                    for content in arrays["content"].split(self.c["rows"])])}

    def style(self, content, tap):  # (rows, d_content) -> (1, d_style)
        x = {"Mean": content.mean(0, keepdim=True), "First": content[:1],
             "Last": content[-1:]}[self.c["pool"]]
        for n, layer in enumerate(self.layers):
            x = F.leaky_relu(layer(x), self.c["alpha"])
            tap(f"hidden.{n}", x)
        return self.output_layer(x)
