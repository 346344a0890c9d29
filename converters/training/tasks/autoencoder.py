"""AE_speech and AE_face: sequences to a code and back (thesis 5.5.1, 5.5.2, eq. 5.3)."""

import numpy as np

from ...errors import ConvertError
from .. import losses, statistics
from ..batched import small
from ..data import layout, sampling
from .task import BaseTask


class Task(BaseTask):
    kind = "autoencoder"
    options = {
        "values": "f0",  # of words, or "face": sequences of the channels below
        "channels": list(layout.AU_NAMES),
    }

    def __init__(self, configuration, data, device):
        if configuration["options"]["values"] not in ("f0", "face"):
            raise ConvertError(f"options: values: {configuration['options']['values']!r}, expected "
                               "f0 or face")
        data.need(*(("f0_words",) if configuration["options"]["values"] == "f0"
                    else ("au", "f0_words", "text_words")))
        self._length = configuration["network"].get("config", {}).get("length", 100)
        self.o, self.data = configuration["options"], data
        self.items, self._dev = (self._sequences(split) for split in ("train", "dev"))
        super().__init__(configuration, data, device)

    def fields(self, given):
        return {"normalisations": [statistics.of("values", self.items or [np.zeros(1)], False)],
                **given}

    def _sequences(self, split):
        """Rows of `length` values, zeros behind the end."""
        items = sampling.words(self.data, self.data.select(split))
        if self.o["values"] == "f0":
            return [self._row(self.data.load(u)["f0_words"][word]) for u, word, _ in items]
        columns = [layout.AU_NAMES.index(name) for name in self.o["channels"]]
        faces = sampling.take_windows(self.data, items, 1)[2] if items else []
        return [self._row(face[:, column]) for face in faces for column in columns]

    def _row(self, values):
        row = np.zeros(self._length, np.float32)
        row[:len(values)] = values[:self._length]
        return row

    def dev_items(self):
        return self._dev

    def losses(self, chosen, _rng, _step):
        x = self.module.values.apply(self.tensor(np.stack(chosen)))
        return {"loss": losses.squares(small.reconstruct(self.module, x), x)}
