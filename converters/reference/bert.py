"""BERT (Devlin et al. 2019) and, without token types, DistilBERT (Sanh et al. 2019)."""

import torch
from torch import nn
from torch.nn import functional as F

from ..kinds.bert import CLS, SEP
from .blocks import no_tap


class Embeddings(nn.Module):
    def __init__(self, c):
        super().__init__()
        d = c["d_model"]
        self.word_embeddings = nn.Embedding(c["tokens"], d)
        self.position_embeddings = nn.Embedding(c["positions"], d)
        self.token_type_embeddings = nn.Embedding(c["types"], d) if c["types"] else None
        self.LayerNorm = nn.LayerNorm(d, eps=c["ln_eps"])

    def forward(self, ids):  # (N,) -> (N, D)
        x = self.word_embeddings(ids) + self.position_embeddings.weight[:len(ids)]
        if self.token_type_embeddings is not None:
            x = x + self.token_type_embeddings.weight[0]  # one sentence: all of the first type
        return self.LayerNorm(x)


class SelfAttention(nn.Module):
    def __init__(self, c):
        super().__init__()
        d, self.heads = c["d_model"], c["heads"]
        self.query, self.key, self.value = (nn.Linear(d, d) for _ in range(3))

    def forward(self, x):
        n, d = x.shape
        q, k, v = (layer(x).reshape(n, self.heads, -1).transpose(0, 1)
                   for layer in (self.query, self.key, self.value))
        scores = q @ k.transpose(1, 2) / (d // self.heads) ** 0.5  # (heads, N, N)
        return (scores.softmax(-1) @ v).transpose(0, 1).reshape(n, d)


class Projection(nn.Module):
    """What ends both sub-layers: Linear, residual, LayerNorm."""

    def __init__(self, columns, c):
        super().__init__()
        self.dense = nn.Linear(columns, c["d_model"])
        self.LayerNorm = nn.LayerNorm(c["d_model"], eps=c["ln_eps"])

    def forward(self, y, x):
        return self.LayerNorm(x + self.dense(y))


class Layer(nn.Module):
    """Post-norm encoder block (Vaswani et al. 2017) with GELU."""

    def __init__(self, c):
        super().__init__()
        # Named "self" and "output" inside "attention", as in the published checkpoints.
        self.attention = nn.ModuleDict({"self": SelfAttention(c),
                                        "output": Projection(c["d_model"], c)})
        self.intermediate = nn.ModuleDict({"dense": nn.Linear(c["d_model"], c["d_mlp"])})
        self.output = Projection(c["d_mlp"], c)

    def forward(self, x):
        x = self.attention["output"](self.attention["self"](x), x)
        return self.output(F.gelu(self.intermediate["dense"](x)), x)


class Network(nn.Module):
    """ids (sequences, pieces), zeros behind the end -> hidden, or probabilities of classes and the
    most probable one, act."""

    def __init__(self, network, vocabulary=None):
        super().__init__()
        c = self.c = network["config"]
        self.embeddings = Embeddings(c)
        self.encoder = nn.ModuleDict({"layer": nn.ModuleList(Layer(c) for _ in range(c["layers"]))})
        if c["head"] == "Classifier":
            self.pre_classifier = nn.Linear(c["d_model"], c["d_model"])
            self.classifier = nn.Linear(c["d_model"], len(c["labels"]))
        self.output = "hidden" if c["head"] == "None" else "probabilities"
        self.cls, self.sep = CLS, SEP
        if vocabulary is not None:
            tokens = bytes(vocabulary).decode().split("\n")
            self.cls, self.sep = tokens.index("[CLS]"), tokens.index("[SEP]")

    def weights(self):
        return self

    def forward(self, arrays, tap=no_tap):
        sequences = [ids[:1 + int(ids.nonzero().max())] if ids.any() else ids[:0]
                     for ids in arrays["ids"]]
        if self.c["head"] == "None":
            hidden = torch.zeros(*arrays["ids"].shape, self.c["d_model"], dtype=torch.float64)
            for rows, ids in zip(hidden, sequences):
                if len(ids):
                    rows[:len(ids)] = self.hidden(ids, tap)
            return {"hidden": hidden}
        probabilities = torch.stack([self.classify(ids, tap) for ids in sequences])
        return {"probabilities": probabilities,
                "act": torch.from_numpy(probabilities.numpy().argmax(1))}

    def hidden(self, ids, tap=no_tap):
        """Last layer of every piece; long sequences in chunks that know nothing of each other."""
        return torch.cat([self.encode(chunk, tap)[1:-1]
                          for chunk in ids.split(self.c["positions"] - 2)])

    def classify(self, ids, tap=no_tap):
        first = self.encode(ids, tap)[0]
        return self.classifier(F.relu(self.pre_classifier(first))).softmax(-1)

    def encode(self, ids, tap):
        """[CLS] ids [SEP] -> (2 + pieces, D)."""
        wrapped = torch.cat([torch.tensor([self.cls]), ids, torch.tensor([self.sep])])
        x = self.embeddings(wrapped)
        tap("embeddings/out", x)
        for n, layer in enumerate(self.encoder["layer"]):
            x = layer(x)
            tap(f"layer.{n}/out", x)
        return x
