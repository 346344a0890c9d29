"""Weights files of small networks with random weights, for the tests of the front end."""

import os
import sys

import numpy as np

from cli_harness import ROOT

sys.path.insert(0, ROOT)
from converters import bundle, networks  # noqa: E402
from converters.export import write  # noqa: E402
from converters.random_weights import random_weights  # noqa: E402

D_TEXT = 16
JOINTS = [{"name": "Neck", "parent": -1, "source": 0},
          {"name": "RShoulder", "parent": 0, "source": 1},
          {"name": "LShoulder", "parent": 0, "source": 4}]
CHANNELS = [{"name": "AU01", "unit": "intensity 0 to 5", "minimum": 0.0, "step": 0.5, "levels": 8},
            {"name": "Rx", "unit": "rad", "minimum": -0.3, "step": 0.1, "levels": 8}]
TOKENS = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", ",", ".", "?", "hello", "there", "how", "are", "you",
          "deep", "learn", "##ing", "is", "fun", "well", "yes", "no"]
ACTS = ["question", "statement", "thanks"]
SOUND = {"sample_rate": 8000, "pitch_sample_rate": 8000}


def ast(frames, **more):
    return {"frames": frames, "mel_bins": 12, "patch": 4, "stride": 3, "d_model": 8, "layers": 1,
            "heads": 2, "d_mlp": 12, "head": "LayerNormLinear", "d_out": 6, **more}


def core(**more):
    return {"frames": 16, "d_text": D_TEXT, "d_pose": 6, "d_model": 8, "ast_content": ast(16),
            "ast_shared": True, "attention_heads": 2, "lstm_layers": 1, "lstm_hidden": 5,
            "decoder_layers": 1, "decoder_heads": 2, "decoder_ff": 12, **more}


def bert(**more):
    return {"layers": 1, "d_model": D_TEXT, "heads": 2, "d_mlp": 24, "tokens": len(TOKENS),
            "positions": 12, **more}


SPEECH = {"stream": "speech", "mean": [-6.0], "deviation": [3.0]}
# name -> kind and the fields of the network
NETWORKS = {
    "zs1": ("zs_mstm1", {"config": core(), "joints": JOINTS, "features": SOUND,
                         "normalisations": [SPEECH]}),
    # A frame a second, so that ten hours do not take long.
    "slow": ("zs_mstm1", {"config": core(frame_rate=1.0, decoder_mode="Parallel"),
                          "joints": JOINTS, "features": {**SOUND, "sample_rate": 4000}}),
    "zs2": ("zs_mstm2", {"config": {"core": core(granularity="Segment"), "d_face": 4, "d_tags": 3},
                         "joints": JOINTS, "normalisations": [SPEECH],
                         "features": {**SOUND, "tags": ["statement", "thanks", "question"],
                                      "landmarks": [{"name": "chin", "source": 8},
                                                    {"name": "nose", "source": 30}]}}),
    "model1": ("model1", {"config": {"f0_length": 100, "d_text": D_TEXT, "ae_hidden": 4,
                                     "hidden1": 5, "hidden2": 3, "out_length": 9,
                                     "channels": CHANNELS}, "features": SOUND}),
    "model2": ("model2", {"config": {"max_words": 4, "f0_length": 100, "d_text": D_TEXT,
                                     "d_model": 8, "encoder_heads": 2, "encoder_ff": 12,
                                     "attention_heads": 2, "attention_ff": 10,
                                     "attention_width": 8, "decoder_heads": 2, "decoder_layers": 1,
                                     "decoder_ff": 12, "max_out": 9, "channels": CHANNELS},
                          "features": SOUND}),
    "ast": ("ast", {"config": ast(32), "features": SOUND}),
    "bank": ("ast", {"config": ast(32), "features": {"speech": "FilterBank"}}),
    "bert": ("bert", {"config": bert()}),
    "acts": ("bert", {"config": bert(head="Classifier", labels=ACTS)}),
}


def make(folder, name):
    """Writes one of NETWORKS and gives its path."""
    path = os.path.join(folder, name + ".fb")
    if os.path.exists(path):
        return path
    kind, fields = NETWORKS[name]
    network = networks.complete(kind, fields)
    tensors = random_weights(network, 0)
    if kind == "bert":
        tensors["vocabulary"] = np.frombuffer("\n".join(TOKENS).encode(), np.uint8)
    write(path, network, tensors, {"trained": False, "licence": "as gestus", "recipe": "random"},
          False, [])
    return path


def make_bundle(folder, *names):
    """Writes several of NETWORKS to one file and gives its path."""
    path = os.path.join(folder, "+".join(names) + ".fb")
    if not os.path.exists(path):
        bundle.bundle([f"{name}={make(folder, name)}" for name in names], path)
    return path
