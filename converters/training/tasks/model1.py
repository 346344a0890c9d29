"""Model 1: faces of words by LSTMs (thesis 5.5.3 and 5.5.4, eq. 5.7)."""

import numpy as np

from ...errors import ConvertError
from .. import faces, losses, statistics
from ..batched import model1
from ..data import sampling
from .task import BaseTask


class Task(BaseTask):
    kind = "model1"
    pretrained = ("ae_speech", "ae_face")
    options = {}

    def __init__(self, configuration, data, device):
        data.need("f0_words", "text_words", "au")
        faces.check_rate(data)
        super().__init__(configuration, data, device)
        if self.network["config"]["text_rows"] != 1:
            raise ConvertError("network: config: text_rows: expected 1, the text of one word")
        self.items, self._dev = (sampling.words(data, data.select(split))
                                 for split in ("train", "dev"))

    def fields(self, given):
        f0 = (self.data.load(u)["f0_words"] for u in self.data.select("train"))
        config = {"d_text": self.data.d_text, **given.get("config", {})}
        return {"normalisations": [statistics.of("f0", f0, False)], **given, "config": config}

    def take_pretrained(self, states):
        """E_speech of AE_speech and, where it fits, D_face of AE_face (5.5.3)."""
        own, taken = self.module.state_dict(), 0
        for name, source, targets in (
                ("ae_speech", "encoder.", ["e1_speech."]),
                ("ae_face", "decoder.", [f"d_face.{n}." for n in range(len(self.module.d_face))])):
            for key, x in states.get(name, {}).items():
                for target in targets if key.startswith(source) else ():
                    ours = target + key.removeprefix(source)
                    if ours in own and own[ours].shape == x.shape:
                        own[ours].copy_(x)
                        taken += 1
        return taken

    def dev_items(self):
        return self._dev

    def losses(self, chosen, _rng, _step):
        f0, text, found = sampling.take_windows(self.data, chosen, 1)
        c = self.network["config"]
        targets = self.tensor(faces.tokens_of(found, c["channels"], c["out_length"]))
        logits = model1.logits(self.module, self.tensor(np.ascontiguousarray(f0[:, 0])),
                               self.tensor(text))
        return {"loss": losses.tokens(logits, targets)}
