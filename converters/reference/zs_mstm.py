"""What both versions of ZS-MSTM share (thesis chapters 6 and 7), with every reading that a weights
file can state."""

import torch
from torch import nn

from ..kinds.zs_mstm1 import d_content, output_row, style_ast
from .ast import Ast
from .blocks import causal_mask, no_tap, normalisation_of, scoped, sinusoidal_positions


class Encoders(nn.Module):
    """E_content (6.5.1) and, but for the LSTMs, E_style (6.5.2)."""

    def __init__(self, network, c):
        super().__init__()
        self.c = c
        self.speech, self.text = (normalisation_of(network, stream)
                                  for stream in ("speech", "text"))
        self.ast_content = Ast(c["ast_content"])
        if not c["ast_shared"]:
            self.ast_style = Ast(c["ast_style"])
        self.content_attention = nn.MultiheadAttention(d_content(c), c["attention_heads"])
        self.style_attention = nn.MultiheadAttention(style_ast(c)["d_out"] + c["d_text"],
                                                     c["attention_heads"])

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

    def style(self, speech, text, tap):
        """sa([X_text, E_speech]) of one segment of the clip, pooled: (d_att,)."""
        ast = self.ast_content if self.c["ast_shared"] else self.ast_style
        e_speech = ast(self.speech.apply(speech), scoped(tap, "ast"))  # (1, d_ast)
        x_text = self.rows_of_text(text)  # (T, d_text)
        s = torch.cat([x_text, e_speech.expand(len(x_text), -1)], 1)
        sa = self.style_attention(s, s, s)[0]  # (T, d_att)
        tap("attention", sa)
        return {"Mean": sa.mean(0), "First": sa[0], "Last": sa[-1]}[self.c["style_pool"]]

    def rows_of_text(self, text):
        x = self.text.apply(text)
        return x if self.c["granularity"] == "Frame" else x.mean(0, keepdim=True)


class Generator(nn.Module):
    """Transformer decoder of G (6.5.3): z (rows, d_model) -> what it puts out (T, columns)."""

    def __init__(self, c, columns):
        super().__init__()
        self.c, self.columns = c, columns
        d, row = c["d_model"], output_row(c, columns)
        if c["decoder_mode"] == "Autoregressive":
            self.embedding = nn.Linear(row, d)
        layer = nn.TransformerDecoderLayer(d, c["decoder_heads"], c["decoder_ff"], dropout=0.0,
                                           layer_norm_eps=c["decoder_ln_eps"])
        self.decoder = nn.TransformerDecoder(layer, c["decoder_layers"])
        self.head = nn.Linear(d, row)

    def forward(self, z, tap):
        tap("z", z)
        if self.c["decoder_mode"] == "Autoregressive":
            target = self.autoregressive_target(z)
        elif self.c["decoder_mode"] == "ShiftedParallel":
            target = torch.cat([torch.zeros_like(z[:1]), z[:-1]])
        else:
            target = z
        out = self.head(self.decode(target, z, tap)).reshape(-1, self.columns)
        tap("head", out)
        return out

    def autoregressive_target(self, z):
        """Rows embed(out_{j-1}), each row put out decoded greedily from the rows before it."""
        out = [torch.zeros_like(self.head(z[:1]))]
        while len(out) < len(z):
            target = self.embedding(torch.cat(out))
            out.append(self.head(self.decode(target, z, no_tap)[-1:]))
        return self.embedding(torch.cat(out))

    def decode(self, target, memory, tap):
        x = target
        if self.c["positions"] == "Sinusoidal":
            x = x + sinusoidal_positions(*x.shape).to(x.dtype)
        for n, layer in enumerate(self.decoder.layers):
            x = layer(x, memory, tgt_mask=causal_mask(len(x)))
            tap(f"decoder.{n}", x)
        return x


def last_hidden(lstm, x, name, tap):
    """"The last hidden layer" of a stacked LSTM: h of its top layer after the last frame."""
    for k, layer in enumerate(single_layers(lstm)):
        x, (last, _) = layer(x)
        tap(f"{name}.{k}", x)
    return last[0]


def single_layers(lstm):
    """The layers of a stacked LSTM, one by one: nn.LSTM shows only the output of its top layer."""
    for k in range(lstm.num_layers):
        layer = nn.LSTM(lstm.hidden_size if k else lstm.input_size, lstm.hidden_size)
        for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh"):
            setattr(layer, name + "_l0", getattr(lstm, f"{name}_l{k}"))
        yield layer
