"""Reader of a prepared data set (layout.py).

    data = Dataset.open("data/")
    for utterance in data.select(split="train"):
        arrays = data.load(utterance)      # {"speech": (frames, 128), "pose": (frames, 22), ...}
"""

import collections
import dataclasses
import pathlib
import zipfile

import numpy as np

from ... import strict_json
from ...errors import ConvertError
from . import layout

# What is read once stays in memory up to this: three hours of the corpus are 0.3 GB.
CACHE_BYTES = 1 << 30


@dataclasses.dataclass(frozen=True)
class Utterance:
    """A stretch of speech by one speaker; `frames` of motion, `words` with the commas that stand
    for short silences, `units` between longer ones."""
    id: str
    speaker: str
    split: str
    frames: int
    words: int
    units: int

    @property
    def path(self):
        return f"{self.speaker}/{self.id}.npz"


class Dataset:
    """`arrays`: the names that every utterance has, of layout.ALL; `features`: how they were made,
    as weights files say it; `known_speakers`: what a corpus knows of its speakers, by name."""

    def __init__(self, folder, header, utterances, cache_bytes=CACHE_BYTES):
        self.folder = pathlib.Path(folder)
        self.arrays = tuple(header["arrays"])
        self.rate = header["rate"]
        self.face_rate = header["face_rate"]
        self.front_end = header["front_end"]
        self.features = header.get("features", {})
        self.known_speakers = header.get("speakers", {})
        self.d_text = header["d_text"]
        self.mel_bins = header["mel_bins"]
        self.columns = layout.columns(self.mel_bins, self.d_text)
        self.utterances = utterances
        self._cache = collections.OrderedDict()
        self._room = cache_bytes

    @classmethod
    def open(cls, folder, **options):
        path = pathlib.Path(folder) / "dataset.json"
        if not path.is_file():
            raise ConvertError(f"{path}: missing, expected a data set that "
                               "`python3 -m converters.training prepare` made")
        header = strict_json.parse(path.read_bytes(), str(path))
        _check_header(path, header)
        utterances = [_utterance(path, n, entry) for n, entry in enumerate(header["utterances"])]
        twice = [x for x, n in collections.Counter(u.path for u in utterances).items() if n > 1]
        if twice:
            raise ConvertError(f"{path}: utterances: {twice[0]} is there twice")
        return cls(folder, header, utterances, **options)

    def select(self, split=None, speaker=None):
        """The utterances of a split and a speaker, or of all of them, in the file's order."""
        return [u for u in self.utterances
                if split in (None, u.split) and speaker in (None, u.speaker)]

    def speakers(self, split=None):
        """Names, sorted."""
        return sorted({u.speaker for u in self.select(split)})

    def need(self, *names):
        """An error unless every utterance has these arrays."""
        for name in names:
            if name not in self.arrays:
                raise ConvertError(f"{self.folder / 'dataset.json'}: no {name} in the recordings "
                                   f"that it was made of, only {', '.join(self.arrays)}")

    def load(self, utterance):
        """{array: (rows, columns)}, checked; float32, or int32 for layout.INTEGERS."""
        key = utterance.path
        if key in self._cache:
            self._cache.move_to_end(key)
            return self._cache[key]
        arrays = self._read(utterance)
        self._cache[key] = arrays
        self._room -= _bytes(arrays)
        while self._room < 0 and len(self._cache) > 1:
            self._room += _bytes(self._cache.popitem(last=False)[1])
        return arrays

    def check(self):
        """Reads and checks every array of every utterance."""
        for utterance in self.utterances:
            self._read(utterance)

    def _read(self, utterance):
        path = self.folder / utterance.path
        try:
            with np.load(path, allow_pickle=False) as file:
                missing = [name for name in self.arrays if name not in file.files]
                if missing:
                    raise ConvertError(f"{path}: no array {missing[0]}, which dataset.json names")
                arrays = {name: file[name] for name in self.arrays}
        except FileNotFoundError:
            raise ConvertError(f"{path}: missing, dataset.json names it") from None
        except (ValueError, OSError, EOFError, zipfile.BadZipFile) as error:
            raise ConvertError(f"{path}: no .npz that can be read: {str(error)[:100]}") from None
        for name, array in arrays.items():
            _check_array(f"{path}: {name}", array, self._shape(utterance, name), name)
        return arrays

    def _shape(self, utterance, name):
        rows = (utterance.frames if name in layout.FRAMES
                else utterance.words if name in layout.WORDS else None)
        columns = self.columns[name]
        return (rows,) if columns is None else (rows, columns)


def _bytes(arrays):
    return sum(array.nbytes for array in arrays.values())


def _check_array(where, array, shape, name):
    """`shape` may hold None for any number of rows."""
    fits = array.ndim == len(shape) and all(w in (None, n) for w, n in zip(shape, array.shape))
    if not fits:
        wanted = tuple("any" if n is None else n for n in shape)
        raise ConvertError(f"{where}: shape {array.shape}, expected {wanted}".replace("'", ""))
    dtype = np.int32 if name in layout.INTEGERS else np.float32
    if array.dtype != dtype:
        raise ConvertError(f"{where}: {array.dtype}, expected {np.dtype(dtype)}")
    if not np.isfinite(array).all():
        raise ConvertError(f"{where}: no finite number at {np.argwhere(~np.isfinite(array))[0]}")


def _check_header(path, header):
    if not isinstance(header, dict) or header.get("version") != layout.VERSION:
        found = header.get("version") if isinstance(header, dict) else "no object"
        raise ConvertError(f"{path}: version {found}, expected {layout.VERSION}")
    kinds = {"rate": (int, float), "face_rate": (int, float), "front_end": str, "d_text": int,
             "mel_bins": int, "arrays": list, "utterances": list}
    for name, kind in kinds.items():
        if not isinstance(header.get(name), kind) or isinstance(header[name], bool):
            raise ConvertError(f"{path}: {name}: {str(header.get(name))[:40]}, expected "
                               f"{'a number' if kind == (int, float) else kind.__name__}")
        if isinstance(header[name], (int, float)) and header[name] <= 0:
            raise ConvertError(f"{path}: {name}: {header[name]}, expected more than 0")
    strange = [name for name in header["arrays"] if name not in layout.ALL]
    if strange:
        raise ConvertError(f"{path}: arrays: {str(strange[0])[:40]}, expected some of "
                           f"{', '.join(layout.ALL)}")
    if not header["utterances"]:
        raise ConvertError(f"{path}: utterances: none, expected at least one")


def _utterance(path, number, entry):
    where = f"{path}: utterance {number}"
    if not isinstance(entry, dict):
        raise ConvertError(f"{where}: expected an object")
    for name in ("id", "speaker"):
        if not isinstance(entry.get(name), str) or not layout.NAME.fullmatch(entry[name]):
            raise ConvertError(f"{where}: {name}: {str(entry.get(name))[:40]!r}, expected letters, "
                               "digits, . _ and -")
    if entry.get("split") not in layout.SPLITS:
        raise ConvertError(f"{where}: split: {str(entry.get('split'))[:40]!r}, expected one of "
                           f"{', '.join(layout.SPLITS)}")
    for name in ("frames", "words", "units"):
        if type(entry.get(name)) is not int or entry[name] < 0:
            raise ConvertError(f"{where}: {name}: {str(entry.get(name))[:40]}, expected a count")
    return Utterance(*(entry[field.name] for field in dataclasses.fields(Utterance)))
