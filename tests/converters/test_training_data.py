"""Prepared data sets: what is written is read back, windows are the engine's, faults are lines."""

import json
import re

import numpy as np
import pytest

from converters.errors import ConvertError
from converters.training.data import sampling
from converters.training.data.dataset import Dataset
from converters.training.data.writer import Writer

D_TEXT = 8
# Two units; the second has a short silence as its third item.
UNITS = [0, 0, 0, 1, 1, 1, 1]
COMMAS = [0, 0, 0, 0, 0, 1, 0]


def arrays(rng, frames=40):
    words = len(UNITS)
    begin = np.array([0, 200, 400, 1000, 1200, 1400, 1450])
    return {"speech": rng.normal(size=(frames, 128)), "text": rng.normal(size=(frames, D_TEXT)),
            "pose": rng.normal(size=(frames, 22)), "face": rng.normal(size=(frames, 30)),
            "tags": np.eye(38)[rng.integers(0, 38, frames)],
            "f0_words": rng.uniform(80, 200, (words, 100)),
            "text_words": rng.normal(size=(words, D_TEXT)), "word_unit": UNITS,
            "word_ms": np.stack([begin, begin + [200, 200, 200, 200, 200, 50, 200]], axis=1),
            "word_comma": COMMAS, "au": rng.normal(size=(64, 9))}


@pytest.fixture(name="folder")
def make_folder(tmp_path):
    rng = np.random.default_rng(1)
    writer = Writer(tmp_path, {"face_rate": 24.0, "front_end": "0" * 16, "d_text": D_TEXT,
                               "mel_bins": 128})
    for n, split in enumerate(("train", "train", "dev", "unseen")):
        writer.add(f"u{n}", f"speaker{n // 2}", split, arrays(rng))
    writer.close()
    return tmp_path


def test_round_trip(folder):
    data = Dataset.open(folder)
    data.check()
    assert [u.id for u in data.select("train")] == ["u0", "u1"]
    assert data.speakers("dev") == ["speaker1"]
    wanted = arrays(np.random.default_rng(1))
    found = data.load(data.utterances[0])
    for name, array in wanted.items():
        np.testing.assert_allclose(found[name], np.asarray(array), rtol=1e-6)


def test_the_cache_forgets(folder):
    data = Dataset.open(folder, cache_bytes=1)
    first = data.load(data.utterances[0])
    data.load(data.utterances[1])
    np.testing.assert_array_equal(data.load(data.utterances[0])["pose"], first["pose"])


def test_segments_cover_all_frames(folder):
    data = Dataset.open(folder)
    items = sampling.segments(data.select("train"), 16)
    assert [first for u, first in items if u.id == "u0"] == [0, 16, 24]
    taken = sampling.take_segments(data, items, 16, ("pose", "tags"))
    assert taken["pose"].shape == (6, 16, 22) and taken["tags"].shape == (6, 38)
    tags = data.load(items[0][0])["tags"][:16]
    np.testing.assert_array_equal(taken["tags"][0], tags.any(axis=0))
    assert not sampling.segments(data.select("train"), 64)


def test_windows_begin_and_end_with_a_word(folder):
    data = Dataset.open(folder)
    one = data.select("dev")

    def cut(most):
        return [(first, count) for _, first, count in sampling.windows(data, one, most)]
    assert cut(10) == [(0, 3), (3, 4)]
    assert cut(3) == [(0, 3), (3, 2), (6, 1)]
    assert cut(2) == [(0, 2), (2, 1), (3, 2), (6, 1)]
    assert [word for _, word, _ in sampling.words(data, one)] == [0, 1, 2, 3, 4, 6]


def test_windows_take_the_face_of_their_time(folder):
    data = Dataset.open(folder)
    items = sampling.windows(data, data.select("dev"))
    f0, text, faces = sampling.take_windows(data, items)
    stored = data.load(items[0][0])
    assert f0.shape == (2, 10, 100) and text.shape == (2, 10, D_TEXT)
    assert not f0[0, 3:].any() and not text[0, 3:].any()
    np.testing.assert_array_equal(faces[0], stored["au"][:14])  # 0 to 600 ms at 24 a second
    np.testing.assert_array_equal(faces[1], stored["au"][24:40])


def test_batches_follow_their_seed(folder):
    items = list(range(10))

    def drawn(seed):
        return list(sampling.batches(items, 4, np.random.default_rng(seed)))
    assert drawn(1) == drawn(1) != drawn(2)
    assert sorted(sum(drawn(1), [])) == items
    assert [len(b) for b in sampling.batches(items, 4, np.random.default_rng(0), True)] == [4, 4]


def change(folder, **fields):
    path = folder / "dataset.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **fields}))


@pytest.mark.parametrize("fields, message", [
    ({"version": 2}, "version 2, expected 1"),
    ({"arrays": ["speech", "smell"]}, "arrays: smell, expected some of"),
    ({"d_text": True}, "d_text: True, expected int"),
    ({"utterances": []}, "utterances: none"),
    ({"utterances": [{"id": "../x"}]}, "utterance 0: id: '../x', expected letters"),
])
def test_headers_that_are_refused(folder, fields, message):
    change(folder, **fields)
    with pytest.raises(ConvertError, match=re.escape(message)):
        Dataset.open(folder)


def test_arrays_that_are_refused(folder):
    data = Dataset.open(folder)
    path = folder / data.utterances[0].path
    good = dict(np.load(path))

    def refused(message, **arrays):
        np.savez(path, **{**good, **arrays})
        with pytest.raises(ConvertError, match=message):
            data.check()
    refused(r"u0.npz: pose: shape \(40, 20\), expected \(40, 22\)", pose=good["pose"][:, :20])
    refused("face: no finite number at", face=good["face"] * np.float32("nan"))
    refused("au: float64, expected float32", au=good["au"].astype(float))
    path.write_bytes(b"nothing")
    with pytest.raises(ConvertError, match="no .npz that can be read"):
        data.check()
    path.unlink()
    with pytest.raises(ConvertError, match="missing, dataset.json names it"):
        data.check()


def test_what_is_not_there_is_said(tmp_path):
    with pytest.raises(ConvertError, match="dataset.json: missing"):
        Dataset.open(tmp_path)
