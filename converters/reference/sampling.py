"""How a run picks tokens from logits: the most probable, or drawn from a seeded stream."""

import numpy as np


def greedy(logits):
    return int(logits.numpy().argmax())  # the lowest of equals


class Sampler:
    """Draws from softmax(logits / temperature) over the `top_k` largest logits (0: all).

    Uniform numbers are the upper 24 bits of MT19937's outputs, one for every pick, so that any
    implementation of the generator draws the same.
    """

    def __init__(self, temperature, top_k=0, seed=0):
        self.temperature, self.top_k = temperature, top_k
        self._stream = np.random.RandomState(seed)

    def uniform(self):
        bits = self._stream.randint(0, 1 << 32, dtype=np.uint32)
        return (int(bits) >> 8) * 2.0 ** -24

    def __call__(self, logits):
        x = logits.numpy()
        # A stable sort of descending values keeps the lower of equal tokens.
        kept = np.sort(np.argsort(-x, kind="stable")[:self.top_k or len(x)])
        p = np.exp((x[kept] - x[kept].max()) / self.temperature)
        above = np.cumsum(p / p.sum()) > self.uniform()
        return int(kept[above.argmax() if above.any() else -1])
