"""Writes a prepared data set (layout.py), an utterance at a time."""

import json
import pathlib

import numpy as np

from . import layout


class Writer:
    """`header`: face_rate, front_end, d_text, mel_bins; also features and speakers, if known.  The
    data set is there once close() wrote dataset.json."""

    def __init__(self, folder, header):
        self.folder = pathlib.Path(folder)
        self.header = {"version": layout.VERSION, "rate": layout.FRAME_RATE, **header}
        self.entries, self.common = [], None
        (self.folder / "dataset.json").unlink(missing_ok=True)

    def add(self, name, speaker, split, arrays):
        """`arrays` in the types of layout.py; those that not all utterances have are not named."""
        self.note(*self.save(self.folder, name, speaker, split, arrays))

    @staticmethod
    def save(folder, name, speaker, split, arrays):
        """Writes the file of an utterance, in any process; returns the arguments of note()."""
        path = pathlib.Path(folder) / speaker / f"{name}.npz"
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, **{key: np.ascontiguousarray(
            array, np.int32 if key in layout.INTEGERS else np.float32)
            for key, array in arrays.items()})
        units = arrays.get("word_unit", ())
        frames = min(len(arrays[key]) for key in layout.FRAMES if key in arrays)
        return ({"id": name, "speaker": speaker, "split": split, "frames": frames,
                 "words": len(units), "units": len(np.unique(units))}, set(arrays))

    def note(self, entry, names):
        """An utterance whose file is there; `names` of its arrays."""
        self.entries.append(entry)
        self.common = names if self.common is None else self.common & names

    def close(self):
        names = [name for name in layout.ALL if name in (self.common or ())]
        header = {**self.header, "arrays": names, "utterances": self.entries}
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "dataset.json").write_text(json.dumps(header, indent=1) + "\n")
