"""A data set of smooth noise, its sentences, and a tiny configuration for each kind of training."""

import numpy as np

from converters.kinds.bert import DIALOG_ACTS
from converters.training.data.writer import Writer

D_TEXT, BINS, RATE = 8, 32, 24.0
WORDS, WORD_MS = 9, 250

AST = {"frames": 16, "mel_bins": BINS, "d_model": 16, "layers": 1, "heads": 2, "d_mlp": 24,
       "d_out": 16}
CORE = {"frames": 16, "d_model": 16, "lstm_layers": 1, "lstm_hidden": 8, "decoder_ff": 24,
        "attention_heads": 2}
CHANNELS = [{"name": "AU01", "minimum": 0, "step": 0.5, "levels": 11, "stack": 0},
            {"name": "Rx", "minimum": -0.5, "step": 0.1, "levels": 11, "stack": 1}]
_ADAM = {"name": "adam", "betas": [0.95, 0.999]}


def configuration(kind, **changes):
    network, options = _NETWORKS[kind], {}
    if kind.startswith("zs"):
        options = {"velocity": 0.5, "behaviour": 0.1, "amount": 0.1, "discriminator": {"hidden": 8},
                   "style_segments": 2, "strange_voices": 0.5}
    return {"kind": kind, "network": {"config": network}, "options": options, "optimiser": _ADAM,
            "schedule": {"name": "constant", "rate": 0.003}, "batch": 4, "steps": 6,
            "dev_every": 3, **changes}


_NETWORKS = {
    "autoencoder": {"hidden": 4, "length": 20},
    "model1": {"ae_hidden": 4, "hidden1": 5, "hidden2": 4, "out_length": 12, "channels": CHANNELS},
    "model2": {"max_words": 3, "d_model": 8, "attention_width": 8, "encoder_layers": 1,
               "encoder_ff": 12, "attention_ff": 12, "decoder_layers": 1, "decoder_ff": 12,
               "max_out": 20, "channels": CHANNELS},
    "classifier": {"frames": 8, "layers": 2, "hidden": 6},
    "zs_mstm1": {**CORE, "ast_content": AST},
    "zs_mstm2": {"core": {**CORE, "ast_content": {**AST, "d_out": 8}}},
    "bert": {"layers": 1, "d_model": 8, "heads": 2, "d_mlp": 12, "positions": 16},
    "acts": {"layers": 1, "d_model": 8, "heads": 2, "d_mlp": 12, "positions": 16},
}


def write(folder, speakers=2, utterances=3, frames=48):
    """A data set: each speaker with `utterances` in split train, and one in dev."""
    writer, rng = Writer(folder, {"face_rate": RATE, "front_end": "0" * 16, "d_text": D_TEXT,
                                  "mel_bins": BINS}), np.random.default_rng(1)
    for speaker in range(speakers):
        for n in range(utterances + 1):
            writer.add(f"s{speaker}u{n}", f"speaker{speaker}", "train" if n else "dev",
                       _arrays(rng, frames, speaker))
    writer.close()
    return folder


def _arrays(rng, frames, speaker):
    def smooth(rows, columns):
        return np.cumsum(rng.normal(size=(rows, columns)), axis=0) * 0.3 + speaker

    begin = np.arange(WORDS) * WORD_MS
    return {"speech": smooth(frames, BINS), "text": smooth(frames, D_TEXT),
            "pose": 30 * smooth(frames, 22), "face": 3 * smooth(frames, 30),
            "tags": np.eye(38)[rng.integers(0, 38, frames)],
            "f0_words": rng.uniform(80, 200, (WORDS, 100)), "text_words": smooth(WORDS, D_TEXT),
            "word_unit": np.arange(WORDS) // 4, "word_comma": np.zeros(WORDS),
            "word_ms": np.stack([begin, begin + WORD_MS - 20], axis=1),
            "au": 0.1 * smooth(int(frames / 15 * RATE), 9)}


def write_texts(folder):
    sentences = ("Well, the old house is green.", "Do you see it?", "Thank you very much!",
                 "I saw the green tree near the house.", "No, not now.")
    lines = [f"{n}\t{'dev' if n % 5 == 4 else 'train'}\t{DIALOG_ACTS[n % 4]}\t"
             f"{sentences[n % 4]} {sentences[n % 5]}" for n in range(30)]
    (folder / "texts.tsv").write_text("id\tsplit\tact\tsentence\n" + "\n".join(lines) + "\n")
    return folder
