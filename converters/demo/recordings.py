"""Recordings of Debian's pocketsphinx-testdata: LibriVox volunteers reading Jane Austen.

The readings are in the public domain; the package that ships them is under the BSD licence.
"""

import pathlib
import wave

import numpy as np

from ..errors import ConvertError

FOLDER = pathlib.Path("/usr/share/pocketsphinx/test/data/librivox")
_NAME = "sense_and_sensibility_01_austen_64kb-"


class Recording:
    """The file's path, mono samples in [-1, 1], their rate, and the words with their times in
    seconds."""

    def __init__(self, path, samples, rate, words):
        self.path = path
        self.samples = samples
        self.rate = rate
        self.words = estimate_times(samples, rate, words)

    @property
    def seconds(self):
        return len(self.samples) / self.rate


def load(number):
    """Recording `number` ("0870") with its words from the package's transcription."""
    path = FOLDER / f"{_NAME}{number}.wav"
    if not path.exists():
        raise ConvertError(f"{path}: missing, install pocketsphinx-testdata")
    with wave.open(str(path)) as file:
        if file.getnchannels() != 1 or file.getsampwidth() != 2:
            raise ConvertError(f"{path}: expected 16-bit mono")
        raw = file.readframes(file.getnframes())
        rate = file.getframerate()
    samples = np.frombuffer(raw, "<i2").astype(np.float32) / 32768
    return Recording(path, samples, rate, _words(path.stem))


def _words(stem):
    for line in (FOLDER / "transcription").read_text().splitlines():
        if line.endswith(f"({stem})"):
            return line.removeprefix("<s>").split("</s>")[0].split()
    raise ConvertError(f"{FOLDER / 'transcription'}: no line for {stem}")


def loudness(samples, rate, step=0.01):
    """Root mean square of each `step` seconds."""
    hop = int(rate * step)
    frames = samples[: len(samples) // hop * hop].reshape(-1, hop)
    return np.sqrt(np.mean(frames**2, axis=1))


def estimate_times(samples, rate, words):
    """(word, start, end): nobody aligned these recordings, so the words share the time in which
    there is sound in proportion to their letters."""
    level = loudness(samples, rate)
    audible = np.cumsum(level > 0.12 * np.percentile(level, 95))
    letters = np.array([len(word) + 1.5 for word in words])
    ends = np.cumsum(letters) / letters.sum() * audible[-1]
    starts = np.concatenate([[0], ends[:-1]])

    def seconds(count):
        return float(np.searchsorted(audible, count)) * 0.01

    return [(word, seconds(a + 0.5), seconds(b)) for word, a, b in zip(words, starts, ends)]
