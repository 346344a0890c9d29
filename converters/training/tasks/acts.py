"""Dialog acts: DistilBERT's classifier of sentences (thesis 4.1.4; Sanh et al. 2019)."""

from torch.nn import functional as F

from ...errors import ConvertError
from .. import wordpiece
from ..batched import bert
from .bert import Task as BertTask
from .bert import padded
from .task import BaseTask


class Task(BertTask):
    options = {"vocabulary": 2000}

    def fields(self, given):
        given = super().fields(given)
        return {"name": "acts", **given, "config": {"types": 0, "head": "Classifier",
                                                    **given["config"]}}

    def _add_head(self):
        """The classifier is part of the network."""

    def optimiser_of(self, parameters):
        return BaseTask.optimiser_of(self, parameters)

    def _items(self, split):
        labels = self.network["config"]["labels"]
        known = [s for s in self.data.select(split) if s.act]
        for s in known:
            if s.act not in labels:
                raise ConvertError(f"{self.data.path}: {s.id}: {s.act} is no label of the network")
        return [(self.pieces.encode(s.text), labels.index(s.act)) for s in known]

    def losses(self, chosen, _rng, _step):
        most = self.network["config"]["positions"] - 2
        ids, padding = padded([[wordpiece.CLS, *ids[:most], wordpiece.SEP] for ids, _ in chosen])
        logits = bert.classify(self.module, self.tensor(ids), self.tensor(padding))
        wanted = logits.new_tensor([act for _, act in chosen]).long()
        right = (logits.argmax(1) == wanted).float().mean()
        return {"loss": F.cross_entropy(logits, wanted), "accuracy": right}

    def train(self):
        BaseTask.train(self)

    def state(self):
        return BaseTask.state(self)

    def load(self, state):
        BaseTask.load(self, state)
