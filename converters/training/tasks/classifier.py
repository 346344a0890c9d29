"""Classifier C: is a motion of the source's or of the target's style? (thesis 7.5.1)"""

import numpy as np
import torch
from torch.nn import functional as F

from ...errors import ConvertError
from .. import statistics
from ..batched import small
from ..data import sampling
from .task import BaseTask


class Task(BaseTask):
    kind = "classifier"
    options = {
        "source": [],  # speakers; nobody: every other one of the training split
        "target": [],
        "dropout": 0.5,
    }

    def __init__(self, configuration, data, device):
        data.need("pose")
        super().__init__(configuration, data, device)
        self.target = self._speakers()
        self.frames = self.network["config"]["frames"]
        self.items, self._dev = (self._segments(split) for split in ("train", "dev"))

    def fields(self, given):
        config = {"d_in": self.data.columns["pose"] + self.data.columns["face"],
                  **given.get("config", {})}
        self.streams = ("pose", "face")
        if config["d_in"] == self.data.columns["pose"]:
            self.streams = ("pose",)
        self.data.need(*self.streams)
        motion = (self._joined(self.data.load(u)) for u in self.data.select("train"))
        return {"normalisations": [statistics.of("motion", motion, True)], **given,
                "config": config}

    def _joined(self, arrays):
        return np.concatenate([arrays[name] for name in self.streams], axis=-1)

    def _speakers(self):
        """{speaker: whether it is a target}"""
        known, found = self.data.speakers("train"), {}
        if not self.o["source"] and not self.o["target"]:
            return {speaker: bool(n % 2) for n, speaker in enumerate(known)}
        for name, is_target in (("source", False), ("target", True)):
            for speaker in self.o[name]:
                if speaker not in known:
                    raise ConvertError(f"options: {name}: {speaker}: nobody of split train")
                found[speaker] = is_target
        return found

    def _segments(self, split):
        return [item for speaker in self.target
                for item in sampling.segments(self.data.select(split, speaker), self.frames)]

    def dev_items(self):
        return self._dev

    def losses(self, chosen, _rng, _step):
        taken = sampling.take_segments(self.data, chosen, self.frames, self.streams)
        wanted = torch.tensor([float(self.target[u.speaker]) for u, _ in chosen],
                              device=self.device)
        logits = small.strength(self.module, self.tensor(self._joined(taken)), self.o["dropout"])
        right = ((logits > 0) == (wanted > 0.5)).float().mean()
        return {"loss": F.binary_cross_entropy_with_logits(logits, wanted), "accuracy": right}
