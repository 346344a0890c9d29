"""PATS (Ahuja et al. 2020) to a prepared data set: its features and split, Table 6.2's speakers.

PATS/cmu_intervals_df.csv                  (or below data/)
PATS/processed/SPEAKER/INTERVAL.h5         (or data/processed/...)
"""

import csv
import pathlib

from ... import pats
from ...errors import ConvertError

SEEN = ("shelly", "jon", "fallon", "bee", "ellen", "oliver", "lec_cosmic", "lec_hist", "ytch_prof",
        "ytch_dating", "seth", "conan", "angelica", "rock", "noah", "lec_law")
UNSEEN = ("lec_evol", "almaram", "huckabee", "ytch_charisma", "minhaj", "chemistry")
_INDEX = "cmu_intervals_df.csv"


def index_of(folder):
    """The path of PATS' index in `folder`, or None."""
    folder = pathlib.Path(folder)
    found = [x for x in (folder / _INDEX, folder / "data" / _INDEX) if x.is_file()]
    return found[0] if found else None


def intervals(index):
    """[(interval, speaker, split, path)] of the speakers of Table 6.2: the seen ones' official
    split, and of the unseen ones what is "test" there.  Intervals without a file are left out, as
    PATS leaves out those of missing_intervals.h5."""
    found = []
    with open(index, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file)
        for name in ("dataset", "interval_id", "speaker"):
            if name not in (rows.fieldnames or ()):
                raise ConvertError(f"{index}: line 1: no column {name}, expected PATS' index")
        for row in rows:
            speaker, name = (row["speaker"] or "").strip(), (row["interval_id"] or "").strip()
            split = _split(speaker.lower(), (row["dataset"] or "").strip())
            path = index.parent / "processed" / speaker / f"{name}.h5"
            if split is not None and path.is_file():
                found.append((name, speaker, split, path))
    if not found:
        raise ConvertError(f"{index}: no interval of Table 6.2's speakers is in "
                           f"{index.parent / 'processed'}")
    return found


def _split(speaker, dataset):
    if speaker in UNSEEN:
        return "unseen" if dataset == "test" else None
    return dataset if speaker in SEEN and dataset in ("train", "dev", "test") else None


def arrays(path):
    """{"speech", "text", "pose"} of an interval (converters/pats.py)."""
    return pats.convert([str(path)])[0]
