"""Folders of recordings: the corpus, or people's own.

FOLDER/SPEAKER/RECORDING/   or, of a speaker's only recording, FOLDER/SPEAKER/
    a recording of speech (.wav, .flac, .ogg, .mp3), words with times (any transcript), and motion:
    OpenFace's .csv, OpenPose's files in a folder or beside them, or pose.npz with pose and face as
    the network takes them
FOLDER/index.json           speakers and splits; without it every sub-folder is a speaker
"""

import dataclasses
import hashlib
import pathlib

import numpy as np

from ... import strict_json
from ...errors import ConvertError
from . import layout

_AUDIO = (".wav", ".flac", ".ogg", ".mp3")
_WORDS = (".json", ".textgrid", ".ctm", ".vtt", ".srt", ".tsv", ".txt")
# Ours, which are no transcripts.
_OURS = ("utterance.json", "index.json")
_SHARES = (("train", 0.8), ("dev", 0.1), ("test", 0.1))


@dataclasses.dataclass(frozen=True)
class Recording:
    """`frames` of video, of a figure or a face, may come from openpose, openface and pose."""
    id: str
    speaker: str
    split: str
    path: pathlib.Path
    audio: pathlib.Path
    transcript: pathlib.Path
    openface: pathlib.Path = None
    openpose: pathlib.Path = None
    pose: pathlib.Path = None

    def spoken(self):
        return [self.audio, *self.words()]

    def words(self):
        return ["--words", self.transcript]

    def files(self):
        return self.spoken() + [x for x in (self.openface, self.openpose) if x is not None]

    def motion(self):
        """{"pose", "face"} of pose.npz."""
        if self.pose is None:
            return {}
        with np.load(self.pose, allow_pickle=False) as file:
            found = {name: file[name] for name in ("pose", "face") if name in file.files}
        for name, array in found.items():
            columns = layout.columns(0, 0)[name]
            if array.ndim != 2 or array.shape[1] != columns:
                raise ConvertError(f"{self.pose}: {name}: shape {array.shape}, expected (frames, "
                                   f"{columns})")
        return found


def find(folder, seed, unseen=()):
    """([Recording], speakers of index.json or {}).  Without index.json a recording's split follows
    from its name and `seed`; the speakers named in `unseen` are held out."""
    folder = pathlib.Path(folder)
    if not folder.is_dir():
        raise ConvertError(f"{folder}: no folder, expected one with a folder for each speaker")
    index = folder / "index.json"
    if index.is_file():
        return _indexed(folder, strict_json.parse(index.read_bytes(), str(index)))
    found = []
    for speaker in sorted(x for x in folder.iterdir() if x.is_dir()):
        inside = sorted(x for x in speaker.iterdir() if x.is_dir() and _audio(x))
        for path in inside or [speaker]:
            split = "unseen" if speaker.name in unseen else _split(f"{seed} {path.name}")
            found.append(_recording(path, path.name, speaker.name, split))
    strangers = set(unseen) - {x.speaker for x in found}
    if strangers:
        raise ConvertError(f"--unseen: {min(strangers)}, expected one of the speakers in {folder}")
    if not found:
        raise ConvertError(f"{folder}: no folders, expected one for each speaker")
    return found, {}


def _indexed(folder, index):
    where = str(folder / "index.json")
    if not isinstance(index, dict) or not isinstance(index.get("utterances"), list):
        raise ConvertError(f"{where}: no list of utterances")
    found = []
    for n, entry in enumerate(index["utterances"]):
        if not isinstance(entry, dict) or not all(
                isinstance(entry.get(name), str) for name in ("id", "speaker", "split")):
            raise ConvertError(f"{where}: utterance {n}: expected id, speaker and split")
        if entry["split"] not in layout.SPLITS:
            raise ConvertError(f"{where}: utterance {n}: split {entry['split']!r}, expected one of "
                               f"{', '.join(layout.SPLITS)}")
        path = folder / entry["speaker"] / entry["id"]
        if not path.resolve().is_relative_to(folder.resolve()):
            raise ConvertError(f"{where}: utterance {n}: lies outside of {folder}")
        if not path.is_dir():
            raise ConvertError(f"{path}: no folder, {where} names it")
        found.append(_recording(path, entry["id"], entry["speaker"], entry["split"]))
    return found, index.get("speakers", {})


def _split(text):
    at = int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], "big") / 2**32
    for name, share in _SHARES:
        at -= share
        if at < 0:
            return name
    return "train"


def _audio(path):
    return [x for x in sorted(path.iterdir()) if x.suffix.lower() in _AUDIO]


def _recording(path, name, speaker, split):
    for part in (speaker, name):
        if not layout.NAME.fullmatch(part):
            raise ConvertError(f"{path}: {part[:80]!r}, expected a name of letters, digits, "
                               "'.', '_' and '-'")
    files = sorted(x for x in path.iterdir() if x.is_file())
    audio = _one(path, [x for x in files if x.suffix.lower() in _AUDIO], "recording of speech")
    frames = [x for x in files if x.name.endswith("_keypoints.json")]
    words = _one(path, [x for x in files if x.suffix.lower() in _WORDS and x not in frames
                        and x.name not in _OURS], "transcript")
    faces = [x for x in files if x.suffix.lower() == ".csv"]
    folders = sorted(x for x in path.iterdir() if x.is_dir() and any(x.glob("*_keypoints.json")))
    pose = path / "pose.npz"
    if frames:
        # infer-cli takes a folder whole, so theirs must hold nothing else.
        raise ConvertError(f"{path}: OpenPose's files among others, expected them in a folder of "
                           "their own")
    for what, several in (("OpenFace .csv", faces), ("folder of OpenPose's files", folders)):
        if len(several) > 1:
            raise ConvertError(f"{path}: {len(several)} of {what}, expected one at most")
    if not faces and not folders and not pose.is_file():
        raise ConvertError(f"{path}: no motion, expected OpenFace's .csv, a folder of OpenPose's "
                           "files, or pose.npz")
    return Recording(name, speaker, split, path, audio, words, faces[0] if faces else None,
                     folders[0] if folders else None, pose if pose.is_file() else None)


def _one(path, found, what):
    if len(found) != 1:
        names = ", ".join(x.name for x in found[:4]) or "none"
        raise ConvertError(f"{path}: {what}: {names}, expected one")
    return found[0]
