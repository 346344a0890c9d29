"""Model 2: faces of inter-pausal units by a Transformer (thesis 5.6.2, eq. 5.17)."""

import torch

from .. import faces, losses
from ..batched import model2
from ..data import sampling
from .task import BaseTask


class Task(BaseTask):
    kind = "model2"
    options = {
        "dropout": 0.1,
        # Share of the tokens before a step that is replaced by random levels (faces.corrupted).
        "token_noise": 0.0,
        "spread": 0.0,  # of the target over neighbouring levels, in levels (losses.tokens)
        # The ablations of 5.6.3: what is taken away of the inputs, or A does not attend, so that
        # each word gets the mean of all values.  The fourth is the network's `conv_decoder`.
        "no_speech": False,
        "no_text": False,
        "no_attention": False,
    }

    def __init__(self, configuration, data, device):
        data.need("f0_words", "text_words", "au")
        faces.check_rate(data)
        super().__init__(configuration, data, device)
        words = self.network["config"]["max_words"]
        self.items, self._dev = (sampling.windows(data, data.select(split), words)
                                 for split in ("train", "dev"))

    def initialise(self):
        if self.o["no_attention"]:
            asking = self.module.cross.layer.cross_attn.query
            for parameter in asking.parameters():  # scores of 0 are alike
                torch.nn.init.zeros_(parameter.requires_grad_(False))

    def fields(self, given):
        return {**given, "config": {"d_text": self.data.d_text, **given.get("config", {})}}

    def dev_items(self):
        return self._dev

    def losses(self, chosen, rng, _step):
        c = self.network["config"]
        f0, text, found = sampling.take_windows(self.data, chosen, c["max_words"])
        # Steps behind the longest sequence of the batch teach nothing.
        steps = min(c["max_out"], 1 + max(map(len, found)))
        tokens = faces.tokens_of(found, c["channels"], steps)
        given = faces.before(tokens)
        if self.o["token_noise"]:
            given = faces.corrupted(given, c["channels"], self.o["token_noise"], rng)
        f0 = f0 * (not self.o["no_speech"])
        text = text * (not self.o["no_text"])
        drop = self.o["dropout"] if self.module.training else 0.0
        logits = model2.logits(self.module, self.tensor(f0), self.tensor(text),
                               self.tensor(given), drop)
        return {"loss": losses.tokens(logits, self.tensor(tokens), self.o["spread"])}
