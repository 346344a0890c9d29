"""BERT and DistilBERT (converters/reference/bert.py) on a batch of sequences."""

from torch.nn import functional as F


def encode(network, ids, padding):
    """[CLS] ids [SEP] (B, N) -> (B, N, D); `padding` (B, N) is True behind the end."""
    x = _embed(network.embeddings, ids)
    for layer in network.encoder["layer"]:
        x = layer.attention["output"](_attention(layer.attention["self"], x, padding), x)
        x = layer.output(F.gelu(layer.intermediate["dense"](x)), x)
    return x


def classify(network, ids, padding):
    """Logits of the classes: (B, classes)."""
    return network.classifier(F.relu(network.pre_classifier(encode(network, ids, padding)[:, 0])))


def _embed(embeddings, ids):
    x = (embeddings.word_embeddings(ids)
         + embeddings.position_embeddings.weight[:ids.shape[1]])
    if embeddings.token_type_embeddings is not None:
        x = x + embeddings.token_type_embeddings.weight[0]
    return embeddings.LayerNorm(x)


def _attention(attention, x, padding):
    batch, n, d = x.shape
    q, k, v = (layer(x).reshape(batch, n, attention.heads, -1).transpose(1, 2)
               for layer in (attention.query, attention.key, attention.value))
    scores = q @ k.transpose(2, 3) / (d // attention.heads) ** 0.5
    scores = scores.masked_fill(padding[:, None, None], float("-inf"))
    return (scores.softmax(-1) @ v).transpose(1, 2).reshape(batch, n, d)
