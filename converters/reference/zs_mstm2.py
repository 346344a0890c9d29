"""ZS-MSTM 2.0 (thesis chapter 7): a face and dialog acts beside the body."""

import torch
from torch import nn

from ..kinds.zs_mstm1 import d_content
from ..kinds.zs_mstm2 import d_style
from .blocks import no_tap, normalisation_of, scoped
from .zs_mstm import Encoders, Generator, last_hidden


class Network(nn.Module):
    """speech (T, F), text (T, d_text) and style, or a style clip with one row of tags for each of
    its segments -> pose (T, d_pose) and face (T, d_face).

    T and the length of the style clip are whole numbers of segments.
    """

    output = "pose"

    def __init__(self, network):
        super().__init__()
        c = network["config"]
        core = self.core = c["core"]
        self.pose, self.face = (normalisation_of(network, stream) for stream in ("pose", "face"))
        self.encoders = Encoders(network, core)
        hidden, depth = core["lstm_hidden"], core["lstm_layers"]
        self.pose_lstm = nn.LSTM(core["d_pose"], hidden, depth)
        self.face_lstm = nn.LSTM(c["d_face"], hidden, depth)
        self.pose_generator = Generator(core, core["d_pose"])
        self.face_generator = Generator(core, c["d_face"])
        width = d_content(core) + d_style(c)
        if c["dense_shared"]:
            self.dense = nn.Linear(width, core["d_model"])
        else:
            self.pose_generator.dense = nn.Linear(width, core["d_model"])
            self.face_generator.dense = nn.Linear(width, core["d_model"])

    def weights(self):
        own = dict(self.named_children())
        return nn.ModuleDict({**dict(own.pop("encoders").named_children()), **own})

    def forward(self, arrays, tap=no_tap):
        style = arrays.get("style")
        if style is None:
            clip = (arrays[f"style_{name}"] for name in ("speech", "text", "pose", "face"))
            style = self.style(*clip, arrays["style_tags"], scoped(tap, "style"))
        pose, face = self.generate(arrays["speech"], arrays["text"], style, tap)
        return {"pose": pose, "face": face, "style": style}

    def style(self, speech, text, pose, face, tags, tap=no_tap):
        """h_style of a clip: the mean over its segments."""
        streams = (x.split(self.core["frames"]) for x in (speech, text, pose, face))
        segments = zip(*streams, tags)
        return torch.stack([self.style_of_segment(*s, tap) for s in segments]).mean(0)

    def style_of_segment(self, speech, text, pose, face, tags, tap):
        sa = self.encoders.style(speech, text, tap)
        e_pose = last_hidden(self.pose_lstm, self.pose.apply(pose), "pose_lstm", tap)
        e_face = last_hidden(self.face_lstm, self.face.apply(face), "face_lstm", tap)
        h_style = torch.cat([sa, e_pose, e_face, tags])  # eq. 7.1
        tap("h_style", h_style[None])
        return h_style

    def generate(self, speech, text, style, tap=no_tap):
        window = self.core["frames"] * self.core["context_segments"]
        poses, faces = [], []
        for s_speech, s_text in zip(speech.split(window), text.split(window)):
            h_content = self.encoders.content(s_speech, s_text, scoped(tap, "content"))
            x = torch.cat([h_content, style.expand(len(h_content), -1)], 1)
            poses.append(self.put_out("pose_generator", x, tap))
            faces.append(self.put_out("face_generator", x, tap))
        return self.pose.undo(torch.cat(poses)), self.face.undo(torch.cat(faces))

    def put_out(self, name, x, tap):
        generator = getattr(self, name)
        dense = getattr(generator, "dense", None) or self.dense
        return generator(dense(x), scoped(tap, name))
