"""BERT and DistilBERT (Devlin et al. 2019, Sanh et al. 2019): Hugging Face's keys of BERT, without
"bert."."""

import numpy as np

from .. import layers
from ..checks import divides, expect, positive
from ..kind import Kind

# Classes of DialogTag's DistilBERT, in the order of its outputs (features.md, section 5.6).
DIALOG_ACTS = (
    "Other", "Thanking", "Conventional-closing", "Wh-Question", "Tag-Question",
    "Backchannel in question form", "Yes-No-Question", "Or-Clause", "Conventional-opening",
    "Open-Question", "Response Acknowledgement", "Hedge", "Statement-opinion", "Appreciation",
    "No answers", "Hold before answer/agreement", "Collaborative Completion", "Maybe/Accept-part",
    "Declarative Wh-Question", "Declarative Yes-No-Question", "Negative non-no answers", "Apology",
    "Acknowledge (Backchannel)", "Yes answers", "3rd-party-talk", "Statement-non-opinion",
    "Signal-non-understanding", "Offers, Options Commits", "Dispreferred answers", "Self-talk",
    "Quotation", "Agree/Accept", "Affirmative non-yes answers", "Repeat-phrase", "Downplayer",
    "Action-directive", "Summarize/reformulate", "Rhetorical-Questions",
)
# Of [CLS] and [SEP] where no vocabulary says otherwise.
CLS, SEP = 101, 102


class Bert(Kind):
    config_type = "BertConfig"
    optional = ("vocabulary",)
    gains = {"self.query.weight": 1.3, "self.key.weight": 1.3, "classifier.weight": 2.0}
    tables = {"embeddings.weight": 0.5}

    def defaults(self, config):
        if config.get("head") == "Classifier":
            config.setdefault("labels", list(DIALOG_ACTS))
        return config

    def check(self, config):
        positive(config, "config", "layers", "d_model", "heads", "d_mlp", "tokens")
        divides(config, "config", "heads", "d_model", config["d_model"])
        expect(config["positions"] >= 3, "config", "positions", config["positions"], "at least 3")
        labels = len(config.get("labels", []))
        if config["head"] == "Classifier":
            expect(labels >= 1, "config", "labels", labels, "one for each class")
        else:
            expect(labels == 0, "config", "labels", labels, "none without a classifier")

    def shapes(self, config):
        d, mlp = config["d_model"], config["d_mlp"]
        shapes = {"embeddings.word_embeddings.weight": (config["tokens"], d),
                  "embeddings.position_embeddings.weight": (config["positions"], d)}
        if config["types"]:
            shapes["embeddings.token_type_embeddings.weight"] = (config["types"], d)
        shapes |= layers.norm("embeddings.LayerNorm", d)
        for n in range(config["layers"]):
            layer = f"encoder.layer.{n}."
            for name in ("query", "key", "value"):
                shapes |= layers.linear(f"{layer}attention.self.{name}", d, d)
            shapes |= {**layers.linear(layer + "attention.output.dense", d, d),
                       **layers.norm(layer + "attention.output.LayerNorm", d),
                       **layers.linear(layer + "intermediate.dense", mlp, d),
                       **layers.linear(layer + "output.dense", d, mlp),
                       **layers.norm(layer + "output.LayerNorm", d)}
        if config["head"] == "Classifier":
            shapes |= layers.linear("pre_classifier", d, d)
            shapes |= layers.linear("classifier", len(config["labels"]), d)
        return shapes

    def inputs(self, config, streams, lengths=None):
        """Sequences of `lengths` pieces, filled up with zeros to the longest of them."""
        longest = min(16, config["positions"] - 2)
        lengths = lengths or (longest, (longest + 1) // 2, 1)
        ids = np.zeros((len(lengths), max(lengths)), np.int32)
        for row, length in zip(ids, lengths):
            row[:length] = streams.rng.integers(1, config["tokens"], length)
        return {"ids": ids}


KIND = Bert()
