"""ZS-MSTM 1.0 (thesis chapter 6)."""

import torch
from torch import nn

from ..kinds.zs_mstm1 import d_content, d_style
from .blocks import no_tap, normalisation_of, scoped
from .zs_mstm import Encoders, Generator, last_hidden


class Network(nn.Module):
    """speech (T, F), text (T, d_text) and style, or a style clip -> pose (T, d_pose).

    T and the length of the style clip are whole numbers of segments.
    """

    output = "pose"

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        self.pose = normalisation_of(network, "pose")
        self.encoders = Encoders(network, c)
        self.pose_lstm = nn.LSTM(c["d_pose"], c["lstm_hidden"], c["lstm_layers"])
        self.dense = nn.Linear(d_content(c) + d_style(c), c["d_model"])
        self.generator = Generator(c, c["d_pose"])

    def weights(self):
        generator = dict(self.generator.named_children())
        if "embedding" in generator:
            generator["pose_embedding"] = generator.pop("embedding")
        return nn.ModuleDict({**dict(self.encoders.named_children()), "pose_lstm": self.pose_lstm,
                              "dense": self.dense, **generator})

    def forward(self, arrays, tap=no_tap):
        style = arrays.get("style")
        if style is None:
            style = self.style(arrays["style_speech"], arrays["style_text"], arrays["style_pose"],
                               scoped(tap, "style"))
        return {"pose": self.poses(arrays["speech"], arrays["text"], style, tap), "style": style}

    def style(self, speech, text, pose, tap=no_tap):
        """h_style of a clip: the mean over its segments."""
        segments = zip(*(x.split(self.c["frames"]) for x in (speech, text, pose)))
        return torch.stack([self.style_of_segment(*s, tap) for s in segments]).mean(0)

    def style_of_segment(self, speech, text, pose, tap):
        sa = self.encoders.style(speech, text, tap)
        e_pose = last_hidden(self.pose_lstm, self.pose.apply(pose), "pose_lstm", tap)
        h_style = torch.cat([sa, e_pose])  # eq. 6.2
        tap("h_style", h_style[None])
        return h_style

    def poses(self, speech, text, style, tap=no_tap):
        window = self.c["frames"] * self.c["context_segments"]
        poses = []
        for s_speech, s_text in zip(speech.split(window), text.split(window)):
            h_content = self.encoders.content(s_speech, s_text, scoped(tap, "content"))
            z = self.dense(torch.cat([h_content, style.expand(len(h_content), -1)], 1))
            poses.append(self.generator(z, scoped(tap, "generator")))
        return self.pose.undo(torch.cat(poses))
