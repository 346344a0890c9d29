"""The engine's front end for recordings: what networks would be fed with, by `infer-cli features`.

The front end's weights file holds a BERT and perhaps a classifier of dialog acts.  Beside them go
two networks of random weights whose inputs say what is to be made: one that takes frames
(ZS-MSTM 2.0) and one that takes words (Model 1).
"""

import hashlib
import pathlib
import re

import numpy as np

from ... import bundle, networks, weights_file
from ...errors import ConvertError
from ...export import write
from ...random_weights import random_weights
from .. import engine
from . import layout

# How features are made, as the weights files of the trained networks must say (docs/features.md).
FEATURES = {"sample_rate": 16000, "neck": "Zero"}
_FRAMES, _WORDS = "for_frames", "for_words"
_SMALL = {"layers": 1, "d_model": 16, "heads": 2, "d_mlp": 16}
_FACE_LINE = re.compile(r": \d+ frames? at ([0-9.]+) a second -> openface, (.*)$")


class FrontEnd:
    """Made once; `features` may then be called in any process."""

    def __init__(self, weights, infer_cli, folder):
        """`folder`: a place for the file with all networks."""
        self.infer_cli = str(infer_cli)
        self.digest = hashlib.sha256(pathlib.Path(weights).read_bytes()).hexdigest()
        self.classifier, self.d_text = _text_networks(weights)
        self.file = str(pathlib.Path(folder) / "front_end.fb")
        parts = [str(weights)]
        for name, kind, config in (
                (_FRAMES, "zs_mstm2", {"core": {"d_text": self.d_text, "ast_shared": True,
                                                "ast_content": dict(_SMALL)}}),
                (_WORDS, "model1", {"d_text": self.d_text})):
            path = str(pathlib.Path(folder) / f"{name}.fb")
            # Its landmarks and tags are of the kind's choosing.
            network = networks.complete(kind, {"config": config, "features": dict(FEATURES)})
            write(path, network, random_weights(network, 0), {"trained": False}, False, [])
            parts.append(f"{name}={path}")
        bundle.bundle(parts, self.file)

    def features(self, recording):
        """{array of layout.ALL} of a Recording (recordings.py), whatever can be made of it."""
        arrays, report = self._run(_FRAMES, recording.files())
        found = {name: arrays[name] for name in ("speech", "text") if name in arrays}
        for name in ("pose", "face"):
            if name in arrays:
                found[name] = arrays[name]
        found |= recording.motion()
        if "openface_clean" in arrays:
            found["au"] = _action_units(arrays["openface_clean"], report, recording)
        found |= self._words(recording)
        found["tags"] = self._tags(recording, len(found["speech"]))
        return _cut(found)

    def _run(self, network, inputs):
        return engine.arrays_of(self.infer_cli, ["features", self.file, *inputs, "--no-sound",
                                                 "--network", network])

    def _words(self, recording):
        arrays, _ = self._run(_WORDS, recording.spoken())
        items, words, units = arrays["times_ms"], arrays["word_ms"], arrays["unit_ms"]
        comma, at = np.ones(len(items), np.int32), 0
        for n, item in enumerate(items):
            if at < len(words) and (item == words[at]).all():
                comma[n], at = 0, at + 1
        unit = np.searchsorted(units[:, 0], items[:, 0], side="right") - 1
        return {"f0_words": arrays["f0"], "text_words": arrays["text"], "word_ms": items,
                "word_unit": unit.astype(np.int32), "word_comma": comma}

    def _tags(self, recording, frames):
        """(frames, 38): the act of each sentence on the frames that it touches, as the engine gives
        it to a style clip; without a classifier no act."""
        tags = np.zeros((frames, layout.TAGS), np.float32)
        if self.classifier is None:
            return tags
        arrays, _ = engine.arrays_of(self.infer_cli, [self.file, *recording.words(), "--network",
                                                      self.classifier])
        for act, (start, end) in zip(arrays["act"], arrays["times_ms"]):
            first = int(start * layout.FRAME_RATE / 1000)
            tags[first:int(np.ceil(end * layout.FRAME_RATE / 1000)), act] = 1
        return tags


def _text_networks(path):
    """(name of the classifier or None, width of the BERT)"""
    found = {}
    for network in weights_file.read(str(path)).networks:
        if network["config_type"] == "BertConfig":
            head = network["config"].get("head", "None")
            found[head] = network["name"], network["config"]["d_model"]
    if "None" not in found:
        raise ConvertError(f"{path}: no BERT without a head, expected the front end's weights")
    return found.get("Classifier", (None,))[0], found["None"][1]


def _action_units(values, report, recording):
    """(frames, 9) at 24 frames a second: the engine takes tokens of faces to be so far apart."""
    for line in report["used"]:
        found = _FACE_LINE.search(line)
        if found:
            break
    else:
        raise ConvertError(f"{recording.path}: infer-cli does not say what it read of OpenFace")
    rate, names = float(found.group(1)), found.group(2).split()
    missing = [name for name in layout.AU_NAMES if name not in names]
    if missing:
        raise ConvertError(f"{recording.path}: OpenFace: no column {missing[0]}, expected "
                           + ", ".join(layout.AU_NAMES))
    values = values[:, [names.index(name) for name in layout.AU_NAMES]]
    count = int(len(values) * layout.FACE_RATE / rate + 1e-6)
    at = np.arange(count) * rate / layout.FACE_RATE
    return np.stack([np.interp(at, np.arange(len(values)), column) for column in values.T], axis=1)


def _cut(found):
    """All arrays of frames as long as the shortest."""
    frames = min(len(found[name]) for name in layout.FRAMES if name in found)
    return {name: array[:frames] if name in layout.FRAMES else array
            for name, array in found.items()}
