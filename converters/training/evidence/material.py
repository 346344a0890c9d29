"""Where the evidence comes from: the corpus, the data set made of it, the engine and the weights."""

import functools
import json
import pathlib
import subprocess

import numpy as np

from ... import kinds, weights_file
from ...errors import ConvertError
from .. import engine
from ..corpus import recordings
from ..data import sampling
from ..data.dataset import Dataset

_STYLE_CLIPS = 4  # utterances of a speaker that a style is made of


class Material:
    """`work`: folder for what is made on the way."""

    def __init__(self, corpus, data, weights, infer_cli, work):
        self.corpus, self.weights = pathlib.Path(corpus), pathlib.Path(weights)
        self.data, self.infer_cli, self.work = Dataset.open(data), infer_cli, pathlib.Path(work)
        self.work.mkdir(parents=True, exist_ok=True)

    def recording(self, utterance):
        """The sound and the words."""
        at = self.corpus / utterance.speaker / utterance.id
        return at / "speech.wav", at / "words.json"

    def clips(self, speaker):
        """(utterances that the style is made of, those that its behaviour is measured on): one alone
        would say little of how a speaker moves."""
        train = self.data.select("train", speaker)
        if train:
            return train[:_STYLE_CLIPS], [*self.data.select("dev", speaker),
                                          *self.data.select("test", speaker)]
        own = self.data.select("unseen", speaker)
        half = max(1, len(own) // 2)
        return own[:half][:_STYLE_CLIPS], own[half:] or own

    @functools.lru_cache(maxsize=None)
    def _network(self, name):
        for network in weights_file.read(self.weights).networks:
            if network["name"] == name:
                return network
        raise ConvertError(f"{self.weights}: no network {name}")

    def streams(self, network):
        """The motion that a network of the bundle makes."""
        kind = kinds.kind_of(self._network(network))
        return ("pose", "face") if kind == "zs_mstm2" else ("pose",)

    @functools.lru_cache(maxsize=None)
    def style(self, speaker, network):
        """The style file of a speaker, taken by the engine."""
        folder = self.work / "styles" / network
        folder.mkdir(parents=True, exist_ok=True)
        paths = []
        for n, utterance in enumerate(self.clips(speaker)[0]):
            paths.append(folder / f"{speaker}-{n}.npz")
            np.savez(paths[-1], **self._clip(utterance, network))
        output = folder / f"{speaker}.style"
        self._run("style", "extract", self.weights, *paths, "--network", network, "-o", output)
        return output

    def _clip(self, utterance, network):
        arrays, streams = self.data.load(utterance), self.streams(network)
        clip = {f"style_{name}": arrays[name] for name in ("speech", "text", *streams)}
        if "face" in streams:
            frames = self._network(network)["config"]["core"]["frames"]
            segments = sampling.segments([utterance], frames)
            clip["style_tags"] = sampling.take_segments(self.data, segments, frames,
                                                        ("tags",))["tags"]
        return clip

    def motion(self, utterance, speaker, network):
        """{"pose", "face"}, or what of these the network makes, of an utterance in the style of a
        speaker, with the borders of segments faded as in the demo."""
        arrays, _ = engine.arrays_of(self.infer_cli, [
            self.weights, *self.recording(utterance), "--style", self.style(speaker, network),
            "--network", network, "--crossfade", "0.3"])
        return {name: arrays[name] for name in self.streams(network)}

    def recorded(self, utterance, network):
        """What the utterance's own speaker does."""
        arrays = self.data.load(utterance)
        return {name: arrays[name] for name in self.streams(network)}

    def truth(self, utterance, speaker, network):
        """What the gesturer makes of it: the exact truth of the transfer."""
        made = recordings.transfer(self.corpus, f"{utterance.speaker}/{utterance.id}", speaker)
        return {name: made[name] for name in self.streams(network)}

    def evaluate(self, predictions, truth, *options):
        """The report of `infer-cli eval` on two folders."""
        return json.loads(self._run("eval", predictions, truth, *options, "--json"))

    def _run(self, *arguments):
        done = subprocess.run([self.infer_cli, *map(str, arguments)], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            raise ConvertError(f"infer-cli {arguments[0]}: {done.stderr.strip()[-300:]}")
        return done.stdout


def save(folder, name, **arrays):
    folder.mkdir(parents=True, exist_ok=True)
    np.savez(folder / f"{name}.npz", **arrays)
