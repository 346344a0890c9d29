"""BERT by masked language modelling (Devlin et al. 2019, section 3.1), for a front end of one's own:
the thesis takes bert-base-uncased as it is published."""

import numpy as np
from torch import nn
from torch.nn import functional as F

from ...errors import ConvertError
from .. import wordpiece
from ..batched import bert
from ..data.texts import Texts
from .task import BaseTask

_IGNORED = -100


class Task(BaseTask):
    kind = "bert"
    options = {
        "vocabulary": 2000,  # tokens at most
        "chosen": 0.15,      # share of the pieces that are to be told; of these become
        "masked": 0.8,       # [MASK]
        "random": 0.1,       # another piece; the rest stays
        "comma": 0.3,        # how often a comma stands between sentences, as for a short silence
    }

    @staticmethod
    def open_data(path):
        return Texts.open(path)

    def __init__(self, configuration, data, device):
        self.o, self.data = configuration["options"], data
        if not data.select("train") or not data.select("dev"):
            raise ConvertError(f"{data.path}: expected sentences of splits train and dev")
        self.pieces = wordpiece.WordPiece(wordpiece.learn(
            (s.text for s in data.select("train")), self.o["vocabulary"]))
        super().__init__(configuration, data, device)
        self.items, self._dev = (self._items(split) for split in ("train", "dev"))

    def fields(self, given):
        config = {**given.get("config", {}), "tokens": len(self.pieces.tokens)}
        return {**given, "config": config}

    def initialise(self):
        for module in self.module.modules():
            if isinstance(module, (nn.Linear, nn.Embedding)):
                nn.init.normal_(module.weight, std=0.02 if self._wide() else 0.1)
            if isinstance(module, nn.Linear):
                nn.init.zeros_(module.bias)
        self._add_head()

    def _wide(self):
        return self.network["config"]["d_model"] >= 256

    def _add_head(self):
        d, tokens = (self.network["config"][name] for name in ("d_model", "tokens"))
        self.head = nn.Sequential(nn.Linear(d, d), nn.GELU(), nn.LayerNorm(d),
                                  nn.Linear(d, tokens)).to(self.device)

    def optimiser_of(self, parameters):
        return super().optimiser_of([*parameters, *self.head.parameters()])

    def _items(self, split):
        """Sentences as the engine's features have them: lower case, without punctuation at the ends
        of words."""
        return [self.pieces.encode(" ".join(wordpiece.stripped(s.text)))
                for s in self.data.select(split)]

    def dev_items(self):
        return self._dev

    def _sequence(self, item, pool, rng):
        """An item and others behind it, up to a length that is drawn."""
        most = self.network["config"]["positions"] - 2
        length, ids = int(rng.integers(1, most + 1)), list(item)
        while len(ids) < length:
            if rng.random() < self.o["comma"]:
                ids += self.pieces.encode(",")
            ids += pool[rng.integers(len(pool))]
        return [wordpiece.CLS, *ids[:most], wordpiece.SEP]

    def _batch(self, chosen, rng):
        """Ids (B, N) with some of them hidden, the ids to be told, and padding."""
        pool = self.items if self.module.training else self._dev
        ids, padding = padded([self._sequence(item, pool, rng) for item in chosen])
        able = ~padding & (ids != wordpiece.CLS) & (ids != wordpiece.SEP)
        told = able & (rng.random(ids.shape) < self.o["chosen"])
        targets = np.where(told, ids, _IGNORED)
        fate = rng.random(ids.shape)
        other = rng.integers(len(wordpiece.SPECIAL), len(self.pieces.tokens), ids.shape)
        hidden = np.where(told & (fate < self.o["masked"]), wordpiece.MASK, ids)
        swapped = told & (fate >= self.o["masked"]) & (
            fate < self.o["masked"] + self.o["random"])
        return np.where(swapped, other, hidden), targets, padding

    def losses(self, chosen, rng, _step):
        ids, targets, padding = (self.tensor(x) for x in self._batch(chosen, rng))
        told = targets != _IGNORED
        logits = self.head(bert.encode(self.module, ids, padding)[told])
        targets = targets[told]
        if not len(targets):
            return {"loss": 0.0 * sum(p.sum() for p in self.head.parameters())}
        right = (logits.argmax(1) == targets).float().mean()
        return {"loss": F.cross_entropy(logits, targets), "accuracy": right}

    def train(self):
        super().train()
        self.head.train()

    def state(self):
        return {**super().state(), "head": self.head.state_dict()}

    def load(self, state):
        super().load(state)
        self.head.load_state_dict(state["head"])

    def files(self):
        return {"vocabulary": self.pieces.tokens}


def padded(sequences):
    """(B, longest) int64, and where there is nothing."""
    ids = np.full((len(sequences), max(map(len, sequences))), wordpiece.PAD, np.int64)
    for row, sequence in zip(ids, sequences):
        row[:len(sequence)] = sequence
    lengths = np.array([len(sequence) for sequence in sequences])
    return ids, np.arange(ids.shape[1]) >= lengths[:, None]
