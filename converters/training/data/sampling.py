"""What a model is trained on: segments of frames, words and windows of words, batches by seed."""

import numpy as np

from ...errors import ConvertError


def segments(utterances, frames=64, offset=0):
    """[(utterance, first frame)]: without overlap from `offset` on, the last one moved back so that
    it ends with the speech, as the engine does.  Utterances shorter than a segment are left out."""
    found = []
    for u in utterances:
        starts = list(range(offset, u.frames - frames + 1, frames))
        if u.frames >= frames and (not starts or starts[-1] + frames < u.frames):
            starts.append(u.frames - frames)
        found += [(u, start) for start in starts]
    return found


def take_segments(data, items, frames=64, names=("speech", "text", "pose")):
    """{array: (items, frames, columns)}; tags: (items, 38), 1 where the act occurs."""
    taken = {}
    for name in names:
        rows = [data.load(u)[name][first:first + frames] for u, first in items]
        taken[name] = np.stack(rows)
    if "tags" in taken:
        taken["tags"] = taken["tags"].max(axis=1)
    return taken


def words(data, utterances):
    """[(utterance, word, 1)]: every word that is one, not a comma for a silence.  For Model 1."""
    return [(u, word, 1) for u in utterances for word in range(u.words)
            if not data.load(u)["word_comma"][word]]


def windows(data, utterances, max_words=10):
    """[(utterance, first word, count)]: inter-pausal units cut at `max_words`, as the engine cuts
    them (models/features/word_inputs.cc): a silence between two windows belongs to neither."""
    found = []
    for u in utterances:
        arrays = data.load(u)
        unit, comma = arrays["word_unit"], arrays["word_comma"]
        at = 0
        while at < u.words:
            same = np.append(unit[at:at + max_words] == unit[at], False)
            end = at + int(np.argmin(same))
            if comma[at]:
                at += 1
                continue
            found.append((u, at, end - at - int(comma[end - 1])))
            at = end
    return found


def take_windows(data, items, max_words=10):
    """(f0 (items, max_words, 100), text (items, max_words, d_text), [au (frames, 9)]); rows behind
    the last word are zeros.  au: the face from the first word's begin to the last one's end."""
    f0 = np.zeros((len(items), max_words, data.columns["f0_words"]), np.float32)
    text = np.zeros((len(items), max_words, data.d_text), np.float32)
    faces = []
    for row, (u, first, count) in enumerate(items):
        if count > max_words:
            raise ConvertError(f"{u.id}: a window of {count} words, expected at most {max_words}")
        arrays = data.load(u)
        f0[row, :count] = arrays["f0_words"][first:first + count]
        text[row, :count] = arrays["text_words"][first:first + count]
        begin, end = arrays["word_ms"][first, 0], arrays["word_ms"][first + count - 1, 1]
        at = np.rint(np.array([begin, end]) * data.face_rate / 1000).astype(int)
        faces.append(arrays["au"][at[0]:max(at[1], at[0] + 1)])
    return f0, text, faces


def batches(items, size, rng, drop_last=False):
    """Lists of `size` items in an order that `rng` (numpy.random.Generator) draws."""
    order = rng.permutation(len(items))
    for at in range(0, len(items), size):
        part = order[at:at + size]
        if len(part) == size or not drop_last:
            yield [items[i] for i in part]
