"""texts.tsv of a corpus: what is said, and as what dialog act.

A line: id, split, dialog act (a name of converters/kinds/bert.py:DIALOG_ACTS, or nothing where it is
not known), sentence; separated by tabs.  The first line may name these columns.
"""

import dataclasses
import pathlib

from ...errors import ConvertError
from ...kinds.bert import DIALOG_ACTS
from . import layout

COLUMNS = ["id", "split", "act", "sentence"]


@dataclasses.dataclass(frozen=True)
class Sentence:
    id: str
    split: str
    act: str
    text: str


class Texts:
    def __init__(self, path, sentences):
        self.path, self.sentences = path, sentences

    @classmethod
    def open(cls, path):
        """`path` is the file, or the folder that texts.tsv is in."""
        path = pathlib.Path(path)
        path = path / "texts.tsv" if path.is_dir() else path
        with open(path, encoding="utf-8", errors="replace") as file:
            lines = file.read().splitlines()
        sentences = [_sentence(f"{path}: line {n}", line) for n, line in enumerate(lines, 1)
                     if line and not (n == 1 and line.split("\t") == COLUMNS)]
        return cls(path, sentences)

    def select(self, split):
        return [s for s in self.sentences if s.split == split]


def _sentence(where, line):
    fields = line.split("\t")
    if len(fields) != 4:
        raise ConvertError(f"{where}: {len(fields)} fields, expected id, split, act and sentence")
    found = Sentence(*(field.strip() for field in fields))
    if found.split not in layout.SPLITS:
        raise ConvertError(f"{where}: split {found.split[:40]!r}, expected one of "
                           + ", ".join(layout.SPLITS))
    if found.act and found.act not in DIALOG_ACTS:
        raise ConvertError(f"{where}: dialog act {found.act[:40]!r}, expected one of DialogTag's")
    return found
