"""What a prepared data set holds: the arrays of an utterance, their columns and units.

data/dataset.json     version, rates, widths, the arrays that every utterance has, the utterances
data/SPEAKER/ID.npz   the arrays
"""

import re

VERSION = 1
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,120}")  # of speakers and utterances
FRAME_RATE = 15.0  # of speech, text, pose, face and tags
FACE_RATE = 24.0  # of au, as infer-cli takes tokens of faces to be placed
SPLITS = ("train", "dev", "test", "unseen")
POSE_COLUMNS = 22  # x of PATS' first eleven joints, then y (converters/kinds/zs_mstm1.py)
FACE_COLUMNS = 30  # x of fifteen landmarks, then y (docs/models.md)
TAGS = 38  # dialog acts in DialogTag's order
F0_VALUES = 100  # of a word, one every 10 ms
AU_NAMES = ("AU01_r", "AU02_r", "AU04_r", "AU05_r", "AU06_r", "AU07_r",
            "pose_Rx", "pose_Ry", "pose_Rz")

# Arrays by what their rows are: frames of motion, words, frames of the face's video.  word_unit is
# the inter-pausal unit of a word, word_ms its begin and end, word_comma 1 for a short silence that
# the engine gives as the word ",".
FRAMES = ("speech", "text", "pose", "face", "tags")
WORDS = ("f0_words", "text_words", "word_unit", "word_ms", "word_comma")
VIDEO = ("au",)
ALL = FRAMES + WORDS + VIDEO
INTEGERS = ("word_unit", "word_ms", "word_comma")


def columns(mel_bins, d_text):
    """{array: its columns, or None for one number a row}"""
    return {"speech": mel_bins, "text": d_text, "pose": POSE_COLUMNS, "face": FACE_COLUMNS,
            "tags": TAGS, "f0_words": F0_VALUES, "text_words": d_text, "word_unit": None,
            "word_ms": 2, "word_comma": None, "au": len(AU_NAMES)}
