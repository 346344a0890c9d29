"""Names that published checkpoints give the tensors of BERT, DistilBERT and AST, and ours."""

import re
from typing import NamedTuple, Optional

from .errors import ConvertError


class Source(NamedTuple):
    """Where a tensor of ours comes from: keys of the checkpoint, joined along an axis when there
    are several."""
    keys: tuple
    transpose: bool = False
    join: Optional[int] = None


class Scheme(NamedTuple):
    """`root` and `proof` end two keys that every such checkpoint has; what stands before them is a
    prefix.  Rules are tried in order; "[0]" behind our key is the place of a part that is joined."""
    title: str
    root: str
    proof: str
    rules: tuple  # of (pattern of the whole key, ours)
    epsilon: Optional[float] = None  # of its LayerNorms, where the published code fixes it

    def prefix(self, keys):
        """What stands before the names of this scheme, or None when `keys` do not follow it."""
        for key in keys:
            prefix = _plain(key).removesuffix(self.root)
            if prefix != _plain(key) and not prefix.endswith("roberta."):
                if any(_plain(other) == prefix + self.proof for other in keys):
                    return prefix
        return None

    def ours(self, key, prefix):
        """(our key, place among its parts or None) of a checkpoint's key."""
        key = _plain(key)
        # Heads stand beside the encoder that the prefix ends with.
        beside = prefix[:prefix.rstrip(".").rfind(".") + 1]
        name = key.removeprefix(prefix) if key.startswith(prefix) else key.removeprefix(beside)
        for pattern, replacement in self.rules:
            found = re.fullmatch(pattern, name)
            if found:
                name, _, place = found.expand(replacement).partition("[")
                return name, int(place[0]) if place else None
        return name, None


def _plain(key):
    """Without what TensorFlow's names and those of old checkpoints do differently."""
    key = key.replace("_._", ".")
    return re.sub(r"(LayerNorm\.)(gamma|beta)$", lambda found: found[1] + {
        "gamma": "weight", "beta": "bias"}[found[2]], key)


_ENDS = r"\.(weight|bias)"
_WORDS = "embeddings.word_embeddings.weight"

BERT = Scheme("Hugging Face BERT", _WORDS, "encoder.layer.0.attention.self.query.weight", ())

DISTILBERT = Scheme(
    "Hugging Face DistilBERT", _WORDS, "transformer.layer.0.attention.q_lin.weight",
    tuple((r"transformer\.layer\.(\d+)\." + theirs.replace(".", r"\.") + _ENDS,
           rf"encoder.layer.\1.{ours}.\2") for theirs, ours in {
               "attention.q_lin": "attention.self.query", "attention.k_lin": "attention.self.key",
               "attention.v_lin": "attention.self.value",
               "attention.out_lin": "attention.output.dense",
               "sa_layer_norm": "attention.output.LayerNorm", "ffn.lin1": "intermediate.dense",
               "ffn.lin2": "output.dense", "output_layer_norm": "output.LayerNorm"}.items()))

AST = Scheme(
    "Hugging Face AST", "embeddings.distillation_token",
    "embeddings.patch_embeddings.projection.weight",
    (("embeddings.cls_token", "v.cls_token"), ("embeddings.distillation_token", "v.dist_token"),
     ("embeddings.position_embeddings", "v.pos_embed"),
     (r"embeddings\.patch_embeddings\.projection" + _ENDS, r"v.patch_embed.proj.\1"),
     *((r"encoder\.layer\.(\d+)\.attention\.attention\." + part + _ENDS,
        rf"v.blocks.\1.attn.qkv.\2[{place}") for place, part in enumerate(("query", "key",
                                                                           "value"))),
     *((r"encoder\.layer\.(\d+)\." + theirs.replace(".", r"\.") + _ENDS, rf"v.blocks.\1.{ours}.\2")
       for theirs, ours in {
           "layernorm_before": "norm1", "layernorm_after": "norm2",
           "attention.output.dense": "attn.proj", "intermediate.dense": "mlp.fc1",
           "output.dense": "mlp.fc2"}.items()),
     (r"layernorm" + _ENDS, r"v.norm.\1"), (r"classifier\.layernorm" + _ENDS, r"mlp_head.0.\1"),
     (r"classifier\.dense" + _ENDS, r"mlp_head.1.\1")),
    epsilon=1e-12)

SCHEMES = (DISTILBERT, BERT, AST)


class Named(NamedTuple):
    scheme: Optional[Scheme]
    sources: dict  # our key -> Source; keys that follow no scheme keep their names


def canonical(keys, schemes):
    """Named: `keys` after the first of `schemes` that they follow."""
    for scheme in schemes:
        prefix = scheme.prefix(keys)
        if prefix is not None:
            return Named(scheme, _renamed(keys, scheme, prefix))
    return Named(None, {key: Source((key,)) for key in keys})


def _renamed(keys, scheme, prefix):
    sources, parts = {}, {}
    for key in keys:
        ours, place = scheme.ours(key, prefix)
        if place is not None:
            parts.setdefault(ours, {})[place] = key
        elif ours in sources:
            raise ConvertError(f"{ours}: both {sources[ours].keys[0]} and {key} would be it")
        else:
            sources[ours] = Source((key,))
    for ours, found in parts.items():
        if sorted(found) != [0, 1, 2] or ours in sources:
            raise ConvertError(f"{ours}: made of query, key and value, found {found}")
        sources[ours] = Source(tuple(found[place] for place in range(3)), join=0)
    return sources
