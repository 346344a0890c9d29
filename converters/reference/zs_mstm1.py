"""ZS-MSTM 1.0 (thesis chapter 6) with every reading that the weights file can state."""

import torch
from torch import nn

from ..kinds.zs_mstm1 import d_content, d_style, output_row, style_ast
from .ast import Ast
from .blocks import causal_mask, no_tap, normalisation_of, scoped, sinusoidal_positions


class Network(nn.Module):
    """speech (T, F), text (T, d_text) and style, or a style clip -> pose (T, d_pose).

    T and the length of the style clip are whole numbers of segments.
    """

    output = "pose"

    def __init__(self, network):
        super().__init__()
        c = self.c = network["config"]
        self.speech, self.text, self.pose = (normalisation_of(network, stream)
                                             for stream in ("speech", "text", "pose"))
        d, hidden = c["d_model"], c["lstm_hidden"]
        d_content = c["ast_content"]["d_out"] + c["d_text"]
        self.ast_content = Ast(c["ast_content"])
        if not c["ast_shared"]:
            self.ast_style = Ast(c["ast_style"])
        self.content_attention = nn.MultiheadAttention(d_content, c["attention_heads"])
        self.style_attention = nn.MultiheadAttention(style_ast(c)["d_out"] + c["d_text"],
                                                     c["attention_heads"])
        self.pose_lstm = nn.LSTM(c["d_pose"], hidden, c["lstm_layers"])
        self.dense = nn.Linear(d_content + d_style(c), d)
        if c["decoder_mode"] == "Autoregressive":
            self.pose_embedding = nn.Linear(output_row(c, c["d_pose"]), d)
        layer = nn.TransformerDecoderLayer(d, c["decoder_heads"], c["decoder_ff"], dropout=0.0,
                                           layer_norm_eps=c["decoder_ln_eps"])
        self.decoder = nn.TransformerDecoder(layer, c["decoder_layers"])
        self.head = nn.Linear(d, output_row(c, c["d_pose"]))

    def weights(self):
        return self

    def forward(self, arrays, tap=no_tap):
        style = arrays.get("style")
        if style is None:
            style = self.style(arrays["style_speech"], arrays["style_text"], arrays["style_pose"],
                               scoped(tap, "style"))
        return {"pose": self.poses(arrays["speech"], arrays["text"], style, tap), "style": style}

    # E_style (6.5.2) -------------------------------------------------------------------------

    def style(self, speech, text, pose, tap=no_tap):
        """h_style of a clip: the mean over its segments."""
        segments = zip(*(x.split(self.c["frames"]) for x in (speech, text, pose)))
        return torch.stack([self.style_of_segment(*s, tap) for s in segments]).mean(0)

    def style_of_segment(self, speech, text, pose, tap):
        ast = self.ast_content if self.c["ast_shared"] else self.ast_style
        e_speech = ast(self.speech.apply(speech), scoped(tap, "ast"))  # (1, d_ast)
        x_text = self.rows_of_text(text)  # (T, d_text)
        s = torch.cat([x_text, e_speech.expand(len(x_text), -1)], 1)
        sa = self.style_attention(s, s, s)[0]  # (T, d_att)
        tap("attention", sa)
        pooled = {"Mean": sa.mean(0), "First": sa[0], "Last": sa[-1]}[self.c["style_pool"]]
        # eq. 6.2: h_style = [sa([X_text, E_speech]), E_pose]
        h_style = torch.cat([pooled, self.e_pose(self.pose.apply(pose), tap)])
        tap("h_style", h_style[None])
        return h_style

    def e_pose(self, pose, tap):
        """"The last hidden layer" of the stacked LSTM: h of its top layer after the last frame."""
        for k, layer in enumerate(single_layers(self.pose_lstm)):
            pose, (last, _) = layer(pose)
            tap(f"pose_lstm.{k}", pose)
        return last[0]

    def rows_of_text(self, text):
        x = self.text.apply(text)
        return x if self.c["granularity"] == "Frame" else x.mean(0, keepdim=True)

    # E_content (6.5.1) -----------------------------------------------------------------------

    def content(self, speech, text, tap):
        """h_content of the segments that see one another: (rows, d_att)."""
        rows = []
        for s_speech, s_text in zip(speech.split(self.c["frames"]), text.split(self.c["frames"])):
            # With several segments AST's inner values have no single name, so none is tapped.
            ast_tap = scoped(tap, "ast") if self.c["context_segments"] == 1 else no_tap
            e_speech = self.ast_content(self.speech.apply(s_speech), ast_tap)
            x_text = self.rows_of_text(s_text)
            rows.append(torch.cat([e_speech.expand(len(x_text), -1), x_text], 1))
        c = torch.cat(rows)
        h_content = self.content_attention(c, c, c)[0]  # eq. 6.1
        tap("attention", h_content)
        return h_content

    # G (6.5.3) -------------------------------------------------------------------------------

    def poses(self, speech, text, style, tap=no_tap):
        window = self.c["frames"] * self.c["context_segments"]
        poses = [self.generate(self.content(s, t, scoped(tap, "content")), style,
                               scoped(tap, "generator"))
                 for s, t in zip(speech.split(window), text.split(window))]
        return self.pose.undo(torch.cat(poses))

    def generate(self, h_content, h_style, tap):
        rows = len(h_content)
        z = self.dense(torch.cat([h_content, h_style.expand(rows, -1)], 1))  # (rows, d_model)
        tap("z", z)
        if self.c["decoder_mode"] == "Autoregressive":
            target = self.autoregressive_target(z)
        elif self.c["decoder_mode"] == "ShiftedParallel":
            target = torch.cat([torch.zeros_like(z[:1]), z[:-1]])
        else:
            target = z
        poses = self.head(self.decode(target, z, tap)).reshape(-1, self.c["d_pose"])
        tap("head", poses)
        return poses

    def autoregressive_target(self, z):
        """Rows embed(pose_{j-1}), each pose decoded greedily from the rows before it."""
        poses = [torch.zeros_like(self.head(z[:1]))]
        while len(poses) < len(z):
            target = self.pose_embedding(torch.cat(poses))
            poses.append(self.head(self.decode(target, z, no_tap)[-1:]))
        return self.pose_embedding(torch.cat(poses))

    def decode(self, target, memory, tap):
        x = target
        if self.c["positions"] == "Sinusoidal":
            x = x + sinusoidal_positions(*x.shape).to(x.dtype)
        for n, layer in enumerate(self.decoder.layers):
            x = layer(x, memory, tgt_mask=causal_mask(len(x)))
            tap(f"decoder.{n}", x)
        return x


def single_layers(lstm):
    """The layers of a stacked LSTM, one by one: nn.LSTM shows only the output of its top layer."""
    for k in range(lstm.num_layers):
        layer = nn.LSTM(lstm.hidden_size if k else lstm.input_size, lstm.hidden_size)
        for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh"):
            setattr(layer, name + "_l0", getattr(lstm, f"{name}_l{k}"))
        yield layer
