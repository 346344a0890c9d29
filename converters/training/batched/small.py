"""Autoencoders, classifier C and discriminator Dis on batches."""

from torch.nn import functional as F

from . import recurrent


def reconstruct(network, x):
    """Normalised values (B, L) -> their reconstruction (B, L)."""
    code = recurrent.encode(network.encoder, x[:, :, None])
    rows = recurrent.decode(network.decoder, code.expand(-1, network.c["length"], -1))
    return network.decoder.dense(rows)[:, :, 0]


def strength(network, motion, drop=0.0):
    """Logit of C: motion (B, T, d_in) -> (B,).  `drop` follows each LSTM (thesis 7.5.1)."""
    x = network.motion.apply(motion).transpose(0, 1)
    if network.training:
        network.lstm.dropout = drop
    rows = network.lstm(x)[0]
    return network.dense(F.dropout(rows[-1], drop, network.training))[:, 0]


def discriminate(network, content):
    """Dis: h_content (B, rows, d_content) -> h_style (B, d_style)."""
    x = {"Mean": content.mean(1), "First": content[:, 0],
         "Last": content[:, -1]}[network.c["pool"]]
    for layer in network.layers:
        x = F.leaky_relu(layer(x), network.c["alpha"])
    return network.output_layer(x)
