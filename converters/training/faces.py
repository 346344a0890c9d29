"""Tokens of faces for Models 1 and 2: true sequences, and what precedes each of their steps."""

import numpy as np

from ..channels import SPECIAL
from ..errors import ConvertError
from .data import layout

PAD, START, END = range(3)
RATE = 24  # values a second, as infer-cli puts sequences in time (models/outputs/motion.h)


def check_rate(data):
    if data.face_rate != RATE:
        raise ConvertError(f"{data.folder / 'dataset.json'}: face_rate {data.face_rate}, expected "
                           f"{RATE}, at which the engine puts faces in time")


def columns_of(channels):
    """Which column of `au` each channel is."""
    names = [name.removesuffix("_r").removeprefix("pose_") for name in layout.AU_NAMES]
    for channel in channels:
        if channel["name"] not in names:
            raise ConvertError(f"channel {channel['name']}: expected one of {', '.join(names)}")
    return [names.index(channel["name"]) for channel in channels]


def tokens_of(faces, channels, length):
    """[(frames, 9)] -> (faces, length, channels) int64: levels, the end, and padding; longer ones
    are cut."""
    columns = columns_of(channels)
    minimum, step, levels = (np.array([channel[key] for channel in channels])
                             for key in ("minimum", "step", "levels"))
    found = np.full((len(faces), length, len(channels)), PAD, np.int64)
    for row, face in zip(found, faces):
        level = np.floor((face[:length, columns] - minimum) / step + 0.5)
        row[:len(level)] = SPECIAL + np.clip(level, 0, levels - 1)
        row[len(level):len(level) + 1] = END
    return found


def before(tokens):
    """The token before each step: the start, then the sequence itself."""
    return np.concatenate([np.full_like(tokens[:, :1], START), tokens[:, :-1]], axis=1)


def corrupted(tokens, channels, share, rng):
    """`tokens` with some levels replaced by random ones: of each sequence a share drawn between 0 and
    `share`.  What is fed back when the network decodes by itself is not the truth either."""
    p = rng.random((len(tokens), 1, 1)) * share
    levels = np.array([channel["levels"] for channel in channels])
    noise = SPECIAL + np.floor(rng.random(tokens.shape) * levels).astype(np.int64)
    return np.where((tokens >= SPECIAL) & (rng.random(tokens.shape) < p), noise, tokens)
