"""espeak-ng reads sentences: samples, and the time of every word to the sample."""

import json
import re
import subprocess
import sys
from xml.sax.saxutils import escape

import numpy as np

from ...errors import ConvertError
from . import espeak

RATE = 22050  # Hz, of espeak-ng
# A pause phoneme that lasts longer ends a word; a shorter one belongs to it (closures of stops).
_SHORTEST_PAUSE = 0.06
# Pauses after sentences and within them, in seconds, before the voice's factor.
_AFTER_SENTENCE, _WITHIN = (0.35, 0.75), (0.1, 0.32)
_EMPHASIS = '<emphasis level="strong">', "</emphasis>"


class Reader:
    """A voice.  The same sequence of `read` gives the same samples."""

    def __init__(self, voice):
        self.voice = voice
        self.process = subprocess.Popen(
            [sys.executable, "-m", espeak.__name__], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.stderr.close()
        self.process.wait()

    def read(self, sentences, rng):
        """(float32 samples at RATE, [[(start, end) of each word] of each sentence] in seconds)"""
        at = int(RATE * rng.uniform(0.15, 0.35))
        parts, times = [np.zeros(at, np.float32)], []
        for sentence in sentences:
            samples, spans = self._sentence(sentence.words)
            samples, spans = _shape_pauses(samples, spans, self.voice.pause, rng)
            gap = int(RATE * self.voice.pause * rng.uniform(*_AFTER_SENTENCE))
            parts += [samples, np.zeros(gap, np.float32)]
            times.append([((at + a) / RATE, (at + b) / RATE) for a, b in spans])
            at += len(samples) + gap
        samples = np.concatenate(parts) * 10 ** (self.voice.gain / 20)
        samples += rng.normal(0, 10 ** (self.voice.noise / 20), len(samples)).astype(np.float32)
        return np.clip(samples, -1, 1).astype(np.float32), times

    def _sentence(self, words):
        """(samples, [(first, last) sample of each word])"""
        ssml, places = _ssml(words)
        request = {"voice": self.voice.name, "rate": self.voice.rate, "pitch": self.voice.pitch,
                   "range": self.voice.range, "ssml": ssml}
        try:
            self.process.stdin.write(json.dumps(request).encode() + b"\n")
            self.process.stdin.flush()
            head = self.process.stdout.readline()
        except OSError:
            head = b""
        if not head:
            raise ConvertError("espeak-ng: " + (self.process.stderr.read().decode().strip()
                                                or "ended without a word")[-200:]
                               + ", expected Debian's espeak-ng")
        head = json.loads(head)
        samples = np.frombuffer(self.process.stdout.read(2 * head["samples"]), "<i2") / 32768
        spans = _spans(head["events"], places, head["samples"])
        first, last = spans[0][0], spans[-1][1]
        return (samples[first:last].astype(np.float32),
                [(a - first, b - first) for a, b in spans])


def _ssml(words):
    """(text, [place of each word's first letter, counted from 1 as espeak-ng does])"""
    text, places = "<speak>", []
    for word, emphasis in words:
        before, after = _EMPHASIS if emphasis else ("", "")
        text += before
        places.append(len(text) + 1)
        bare = re.match(r".*?(?=[.,?!]*$)", word).group()
        text += escape(bare) + after + word[len(bare):] + " "
    return text.rstrip() + "</speak>", places


def _spans(events, places, total):
    """Of each word the samples from its event to the next one, or to a pause before that.

    A word without an event of its own (espeak-ng speaks "of the" as one) shares its neighbour's
    time by letters."""
    begins = {}
    for sample, kind, place, _, _ in events:
        if kind == espeak.WORD:
            word = max((n for n, p in enumerate(places) if p <= place), default=0)
            begins.setdefault(word if begins else 0, sample)
    pauses = [a for a, b in _pauses(events, total) if b - a > _SHORTEST_PAUSE * RATE]
    known = sorted(begins)
    spans = []
    for word, after in zip(known, known[1:] + [len(places)]):
        limit = begins.get(after, total)
        end = min([limit, *(a for a in pauses if begins[word] < a < limit)])
        edges = np.linspace(begins[word], end, after - word + 1).astype(int).tolist()
        spans += zip(edges, edges[1:])
    return spans


def _pauses(events, total):
    """[(first, last) sample] of the pause phonemes, "_:" and its like, that follow one another."""
    marks = [e for e in events if e[1] in (espeak.PHONEME, espeak.END)]
    ends = [e[0] for e in marks[1:]] + [total]
    joined = []
    for (a, kind, _, _, name), b in zip(marks, ends):
        if kind != espeak.PHONEME or not name.startswith("_"):
            continue
        if joined and a <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(b, joined[-1][1]))
        else:
            joined.append((a, b))
    return joined


def _shape_pauses(samples, spans, factor, rng):
    """Gives each pause between words a length of its own; the words stay as they are."""
    parts, moved, at = [], [], 0
    shift = 0
    for n, (a, b) in enumerate(spans):
        moved.append((a + shift, b + shift))
        following = spans[n + 1][0] if n + 1 < len(spans) else len(samples)
        if n + 1 == len(spans) or following - b < _SHORTEST_PAUSE * RATE:
            continue
        wanted = int(RATE * factor * rng.uniform(*_WITHIN))
        # What a stop's closure or a sound's end has of the pause stays: 30 ms on either side.
        keep = min(int(0.03 * RATE), (following - b) // 2, wanted // 2)
        parts += [samples[at:b + keep], np.zeros(wanted - 2 * keep, np.float32)]
        at = following - keep
        shift += wanted - (following - b)
    parts.append(samples[at:])
    return np.concatenate(parts), moved
