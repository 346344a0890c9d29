"""--map: which tensors of a checkpoint are ours, as a file of JSON says it.

{"our key": "their key", "layers.{n}.norm.weight": "blocks.{n}.ln.w", "encoder.lstm1.*":
"bidirectional.*", "head.weight": {"from": "out/w", "transpose": true}, "attn.weight": {"from":
["q", "k", "v"], "join": 0}}.  A placeholder stands for a number, a star at the end for the rest.
"""

import re
from typing import NamedTuple, Optional

from . import strict_json
from .errors import ConvertError
from .names import Source

MAX_BYTES = 4 << 20
_PLACEHOLDER = re.compile(r"\{([a-z_]\w*)\}")


class Map(NamedTuple):
    path: str
    rules: list


class Rule(NamedTuple):
    ours: str
    sources: tuple
    transpose: bool
    join: Optional[int]
    pattern: re.Pattern

    @property
    def rank(self):
        """The more a rule leaves open, the later it comes."""
        return self.ours.endswith("*"), bool(_PLACEHOLDER.search(self.ours))


def read(path):
    """The Map in `path`."""
    with open(path, "rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise ConvertError(f"{path}: more than {MAX_BYTES} bytes, expected a map")
    entries = strict_json.parse(data, path)
    if not isinstance(entries, dict) or not entries:
        raise ConvertError(f"{path}: expected an object {{\"our key\": \"their key\"}}")
    return Map(path, [_rule(f"{path}: {ours}: ", ours, entry) for ours, entry in entries.items()])


def _rule(where, ours, entry):
    fields = entry if isinstance(entry, dict) else {"from": entry}
    sources, join = fields.get("from"), fields.get("join")
    sources = [sources] if isinstance(sources, str) else sources
    if not (isinstance(sources, list) and sources and all(isinstance(x, str) for x in sources)
            and set(fields) <= {"from", "transpose", "join"}
            and isinstance(fields.get("transpose", False), bool)):
        raise ConvertError(where + "expected a key, or an object of from, transpose and join")
    if (join is not None) != (len(sources) > 1) or join is not None and type(join) is not int:
        raise ConvertError(where + f"{len(sources)} keys and join {str(join)[:20]}, expected an "
                           "axis exactly when there are several keys")
    names = _PLACEHOLDER.findall(ours)
    for source in sources:
        for name in _PLACEHOLDER.findall(source):
            if name not in names:
                raise ConvertError(where + f"placeholder {{{name}}} of {source} is not in our key")
        if source.endswith("*") > ours.endswith("*"):
            raise ConvertError(where + f"the star of {source} is not in our key")
    return Rule(ours, tuple(sources), fields.get("transpose", False), join, _pattern(ours))


def _pattern(ours):
    text, seen = "", set()
    for n, piece in enumerate(_PLACEHOLDER.split(ours.removesuffix("*"))):
        if n % 2 == 0:
            text += re.escape(piece)
        else:
            text += f"(?P={piece})" if piece in seen else f"(?P<{piece}>[0-9]{{1,9}})"
            seen.add(piece)
    return re.compile(text + ("(?P<STAR>.*)" if ours.endswith("*") else ""))


def expand(given, wanted, checkpoint):
    """our key -> Source for every key of `wanted` that the Map names; all of them must exist."""
    found, chosen = {}, {}
    for rule in sorted(given.rules, key=lambda rule: rule.rank):
        matches = [(key, match) for key in wanted if (match := rule.pattern.fullmatch(key))]
        if not matches:
            raise ConvertError(f"{given.path}: {rule.ours}: no tensor of this network has that "
                               "name")
        for key, match in matches:
            if key not in found:
                found[key], chosen[key] = _source(rule, key, match, given, checkpoint), rule
            elif chosen[key].rank == rule.rank:
                raise ConvertError(f"{given.path}: {key}: named by {chosen[key].ours} and by "
                                   f"{rule.ours}")
    return found


def _source(rule, key, match, given, checkpoint):
    keys = tuple(_fill(source, match.groupdict()) for source in rule.sources)
    for theirs in keys:
        if theirs not in checkpoint.tensors:
            why = checkpoint.why_refused(theirs) or f"not in {checkpoint.name}"
            raise ConvertError(f"{given.path}: {key}: {theirs}: {why}")
    return Source(keys, rule.transpose, rule.join)


def _fill(source, values):
    filled = _PLACEHOLDER.sub(lambda name: values[name[1]], source.removesuffix("*"))
    return filled + (values["STAR"] if source.endswith("*") else "")
