"""Cases of BERT."""

import numpy as np

from .case import Case

SMALL = {"layers": 2, "d_model": 16, "heads": 4, "d_mlp": 24, "tokens": 110, "positions": 12}
DISTIL = {**SMALL, "types": 0, "head": "Classifier", "labels": ["question", "statement", "thanks"]}
# Another place of [CLS] and [SEP] than the default's; pieces are separated by newlines.
VOCABULARY = np.frombuffer("\n".join(
    ["[PAD]", "[UNK]", "[SEP]", *(f"word{i}" for i in range(16)), "[CLS]"]).encode(), np.uint8)


def _case(name, about, config, lengths, vocabulary=None):
    optional = {} if vocabulary is None else {"vocabulary": vocabulary}
    return Case(f"bert_{name}", about, "bert", {"config": config}, sizes={"lengths": lengths},
                optional=optional)


CASES = [
    _case("hidden", "BERT, sequences of unequal length", SMALL, (7, 10, 1, 4)),
    _case("chunks", "BERT, sequences longer than its positions", {**SMALL, "layers": 1},
          (25, 10, 11)),
    _case("no_types", "BERT without token types", {**SMALL, "types": 0, "heads": 1, "layers": 1},
          (6, 3)),
    _case("vocabulary", "BERT with a vocabulary of its own",
          {**SMALL, "tokens": 20, "lower_case": False, "ln_eps": 1e-5}, (6, 8), VOCABULARY),
    _case("classifier", "DistilBERT's classifier", DISTIL, (10, 5, 1, 7, 3, 8)),
    _case("classifier_types", "the same with token types", {**DISTIL, "types": 2, "layers": 1},
          (9, 4)),
]
