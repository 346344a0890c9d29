"""Recordings become prepared data sets: folders of people, PATS, the corpus, what is refused."""

import argparse
import json
import os
import pathlib
import shutil
import wave

import numpy as np
import pytest

from converters import networks
from converters.errors import ConvertError
from converters.export import write
from converters.random_weights import random_weights
from converters.training import __main__ as cli, engine
from converters.training.corpus import recordings as corpus
from converters.training.data import layout, pats, recordings
from converters.training.data.prepare import prepare

ROOT = pathlib.Path(__file__).parents[2]
CLI = pathlib.Path(os.environ.get("INFER_CLI", ROOT / "build/release/bin/infer-cli"))
needs_cli = pytest.mark.skipif(not CLI.is_file(), reason="needs infer-cli, which is built later")
D_TEXT = 16


def write_wav(path, seconds=3.0, rate=16000):
    at = np.arange(int(seconds * rate)) / rate
    sound = sum(np.sin(2 * np.pi * 120 * k * at) / k for k in range(1, 12)) * 0.15
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes((sound * 32767).astype("<i2").tobytes())


# Two units; in the first a silence of 50 ms, which the engine makes the word ",".
WORDS = (("Hello", 0.2, 0.6), ("there,", 0.6, 0.9), ("garden", 0.95, 1.4), ("we", 2.0, 2.2),
         ("sing.", 2.2, 2.7))


def write_words(path):
    path.write_text(json.dumps({"words": [{"word": w, "start": a, "end": b}
                                          for w, a, b in WORDS]}))


def write_openface(path, frames=75, rate=25):
    """Action units that rise, at `rate`, among columns that are not asked for."""
    lines = ["frame, face_id, timestamp, confidence, success, gaze_0_x, "
             + ", ".join(layout.AU_NAMES[6:] + ("AU26_r",) + layout.AU_NAMES[:6])]
    for n in range(frames):
        values = [0.01 * n / rate] * 3 + [0.3] + [k + n / rate for k in range(6)]
        lines.append(f"{n + 1}, 0, {n / rate:.3f}, 0.98, 1, 0.1, "
                     + ", ".join(f"{v:.4f}" for v in values))
    path.write_text("\n".join(lines) + "\n")


def write_openpose(folder, frames=45):
    folder.mkdir()
    for n in range(frames):
        body, face = np.zeros((25, 3)), np.full((70, 3), 0.9)
        for joint, xy in {1: (640, 280), 2: (540, 288), 3: (517, 420), 4: (580, 480 - n),
                          5: (740, 288), 6: (763, 420), 7: (700, 480), 0: (640, 200),
                          15: (624, 182), 16: (656, 182)}.items():
            body[joint] = (*xy, 0.9)
        face[:, 0], face[:, 1] = 600 + np.arange(70), 150 + np.arange(70)
        hand = np.tile([700, 490, 0.9], 21)
        person = {"pose_keypoints_2d": body.ravel().tolist(),
                  "face_keypoints_2d": face.ravel().tolist(),
                  "hand_left_keypoints_2d": hand.tolist()}
        (folder / f"clip_{n:012d}_keypoints.json").write_text(
            json.dumps({"version": 1.3, "people": [person]}))


def person(folder):
    """A recording of a speaker with everything that people may have."""
    folder.mkdir(parents=True)
    write_wav(folder / "talk.wav")
    write_words(folder / "talk.json")
    write_openface(folder / "talk.csv")
    write_openpose(folder / "poses")


@pytest.fixture(name="front_end", scope="session")
def make_front_end(tmp_path_factory):
    """A BERT and a classifier with letters and some words."""
    folder = tmp_path_factory.mktemp("front_end")
    letters = "abcdefghijklmnopqrstuvwxyz"
    tokens = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", ",", ".", "?", "!", "'", "-", *letters,
              *("##" + x for x in letters), "the", "hello", "there", "garden", "we", "sing"]
    vocabulary = folder / "vocab.txt"
    vocabulary.write_text("\n".join(tokens) + "\n")
    from converters import bundle, vocabulary as reader
    parts = []
    for name, head, seed in (("bert", "None", 1), ("acts", "Classifier", 2)):
        network = networks.complete("bert", {"config": {
            "layers": 1, "d_model": D_TEXT, "heads": 2, "d_mlp": 16, "tokens": len(tokens),
            "positions": 400, "head": head}})
        path = folder / f"{name}.fb"
        tensors = random_weights(network, seed)
        tensors["vocabulary"] = reader.read_vocabulary(str(vocabulary), len(tokens))
        write(str(path), network, tensors, {"trained": False}, False, [])
        parts.append(f"{name}={path}")
    bundle.bundle(parts, str(folder / "both.fb"))
    return folder / "both.fb"


def options(folder, output, front_end=None, **more):
    return argparse.Namespace(**{"folder": folder, "output": output, "front_end": front_end,
                                 "infer_cli": str(CLI), "seed": 0, "unseen": (), "jobs": 1, **more})


@needs_cli
def test_a_folder_of_people(tmp_path, front_end):
    person(tmp_path / "in" / "anna" / "talk1")
    person(tmp_path / "in" / "bert")
    data = prepare(options(tmp_path / "in", tmp_path / "out", front_end, unseen=("bert",)))
    data.check()
    assert data.arrays == layout.ALL and data.d_text == D_TEXT
    assert data.features == {"sample_rate": 16000, "neck": "Zero"}
    assert {(u.id, u.speaker) for u in data.utterances} == {("talk1", "anna"), ("bert", "bert")}
    assert [u.speaker for u in data.select("unseen")] == ["bert"]
    arrays = data.load(data.utterances[0])
    assert arrays["word_comma"].tolist() == [0, 0, 1, 0, 0, 0]
    assert arrays["word_unit"].tolist() == [0, 0, 0, 0, 1, 1]
    assert arrays["word_ms"][3].tolist() == [950, 1400]
    assert arrays["speech"].shape == (45, 128) and arrays["pose"].shape == (45, 22)
    # The hum of 120 Hz; the comma has none.
    assert np.abs(arrays["f0_words"][0, :40] - 120).max() < 2 and not arrays["f0_words"][2].any()
    # 75 frames at 25 a second are 72 at 24; AU01 rises by 1 a second, AU07 by as much from 5 on.
    assert arrays["au"].shape == (72, 9)
    seconds = np.arange(72)[4:-8] / 24
    np.testing.assert_allclose(arrays["au"][4:-8, 0], seconds, atol=0.01)
    np.testing.assert_allclose(arrays["au"][4:-8, 6], 0.01 * seconds, atol=0.001)
    # A right wrist that rises, 100 pixels between neck and shoulder.
    assert arrays["pose"][40, 11 + 3] < arrays["pose"][2, 11 + 3] - 40
    # One sentence, one act, on its frames and no others.
    tags = arrays["tags"]
    assert tags[3:40].sum(axis=1).tolist() == [1] * 37
    assert not tags[:3].any() and not tags[41:].any()


@needs_cli
def test_what_the_engine_says_of_a_recording_is_said(tmp_path, front_end):
    person(tmp_path / "in" / "anna")
    (tmp_path / "in" / "anna" / "talk.csv").write_text("frame, timestamp, AU01_r\n1, 0.0, 1.0\n")
    with pytest.raises(ConvertError, match="OpenFace: no column AU02_r, expected AU01_r, AU02_r"):
        prepare(options(tmp_path / "in", tmp_path / "out", front_end))
    (tmp_path / "in" / "anna" / "talk.wav").write_bytes(b"no sound")
    with pytest.raises(ConvertError, match="talk.wav"):
        prepare(options(tmp_path / "in", tmp_path / "out", front_end))
    assert not (tmp_path / "out" / "dataset.json").exists()


@needs_cli
@pytest.mark.skipif(shutil.which("espeak-ng") is None, reason="needs Debian's espeak-ng")
def test_the_corpus_from_end_to_end(tmp_path, front_end):
    plan = corpus.Plan(seed=3, hours=0.001, speakers=1, unseen=1, texts=50, fewest=3, words=(8, 9))
    index = corpus.make(tmp_path / "corpus", plan, CLI)
    splits = [entry["split"] for entry in index["utterances"]]
    assert splits == ["train", "dev", "test"] + ["unseen"] * 3
    data = prepare(options(tmp_path / "corpus", tmp_path / "out", front_end))
    data.check()
    assert data.arrays == layout.ALL
    assert set(data.known_speakers) == {"speaker01", "unseen01"}
    for utterance in data.utterances:
        arrays = data.load(utterance)
        stored = np.load(tmp_path / "corpus" / utterance.path.replace(".npz", "") / "pose.npz")
        np.testing.assert_array_equal(arrays["pose"], stored["pose"][:utterance.frames])
        voiced = arrays["f0_words"].max(axis=1) > 0
        assert voiced[arrays["word_comma"] == 0].mean() > 0.7
    # The truth of a transfer to the own style is what was recorded; to another one it is not.
    first = data.utterances[0]
    name = f"{first.speaker}/{first.id}"
    stored = np.load(tmp_path / "corpus" / name / "pose.npz")["pose"]
    same = corpus.transfer(tmp_path / "corpus", name, first.speaker)["pose"]
    other = corpus.transfer(tmp_path / "corpus", name, "unseen01")["pose"]
    np.testing.assert_array_equal(same, stored)
    assert np.abs(other - stored).max() > 20


def test_splits_of_people_follow_the_seed(tmp_path):
    for n in range(60):
        folder = tmp_path / "anna" / f"talk{n}"
        folder.mkdir(parents=True)
        for name in ("a.wav", "a.json", "a.csv"):
            (folder / name).write_text("")
    one, _ = recordings.find(tmp_path, 1)
    again, _ = recordings.find(tmp_path, 1)
    other, _ = recordings.find(tmp_path, 2)
    assert one == again and [r.split for r in one] != [r.split for r in other]
    assert 35 < sum(r.split == "train" for r in one) < 58
    assert {r.split for r in one} == {"train", "dev", "test"}


@pytest.mark.parametrize("files, message", [
    (("a.wav", "a.json"), "no motion, expected OpenFace"),
    (("a.wav", "a.csv"), "transcript: none, expected one"),
    (("a.wav", "b.wav", "a.json", "a.csv"), "recording of speech: a.wav, b.wav, expected one"),
    (("a.wav", "a.json", "a.csv", "b.csv"), "2 of OpenFace .csv, expected one at most"),
    (("a.wav", "a.json", "x_keypoints.json"), "expected them in a folder of their own"),
])
def test_folders_that_are_refused(tmp_path, files, message):
    folder = tmp_path / "anna" / "talk"
    folder.mkdir(parents=True)
    for name in files:
        (folder / name).write_text("")
    with pytest.raises(ConvertError, match=message):
        recordings.find(tmp_path, 0)


def test_names_that_are_refused(tmp_path):
    folder = tmp_path / "anna" / "my talk"
    folder.mkdir(parents=True)
    for name in ("a.wav", "a.json", "a.csv"):
        (folder / name).write_text("")
    with pytest.raises(ConvertError, match="'my talk', expected a name of letters, digits"):
        recordings.find(tmp_path, 0)


def test_other_faults_are_one_line(tmp_path):
    with pytest.raises(ConvertError, match="no folder, expected one with a folder for each"):
        recordings.find(tmp_path / "nowhere", 0)
    with pytest.raises(ConvertError, match="no folders, expected one for each speaker"):
        recordings.find(tmp_path, 0)
    index = tmp_path / "index.json"
    for content, message in (("[]", "no list of utterances"), ("{", "no JSON"),
                             ('{"utterances": [{"id": "x"}]}', "expected id, speaker and split"),
                             ('{"utterances": [{"id": "x", "speaker": "../..", "split": "dev"}]}',
                              "lies outside"),
                             ('{"utterances": [{"id": "x", "speaker": "y", "split": "best"}]}',
                              "split 'best'")):
        index.write_text(content)
        with pytest.raises(ConvertError, match=message):
            recordings.find(tmp_path, 0)
    index.unlink()
    with pytest.raises(ConvertError, match="--front-end: missing"):
        prepare(options(tmp_path, tmp_path / "out"))
    pose = tmp_path / "pose.npz"
    np.savez(pose, pose=np.zeros((5, 20)))
    recording = recordings.Recording("a", "b", "dev", tmp_path, pose, pose, pose=pose)
    with pytest.raises(ConvertError, match=r"pose: shape \(5, 20\), expected \(frames, 22\)"):
        recording.motion()


def pats_folder(folder):
    h5py = pytest.importorskip("h5py")
    rng = np.random.default_rng(1)
    rows = ["dataset,delta_time,end_time,interval_id,speaker,start_time"]
    for n, (speaker, dataset) in enumerate((("oliver", "train"), ("oliver", "dev"),
                                            ("lec_law", "test"), ("minhaj", "test"),
                                            ("minhaj", "train"), ("ferguson", "train"))):
        rows.append(f"{dataset},10.0,0,{n:06d},{speaker},0")
        path = folder / "processed" / speaker / f"{n:06d}.h5"
        path.parent.mkdir(parents=True, exist_ok=True)
        with h5py.File(path, "w") as file:
            for name, shape in (("audio/log_mel_512", (862, 128)), ("text/bert", (150, 768)),
                                ("pose/normalize", (150, 104))):
                file.create_dataset(name, data=rng.normal(size=shape))
    (folder / "cmu_intervals_df.csv").write_text("\n".join(rows) + "\n")


def test_pats_has_its_official_split_and_the_speakers_of_table_6_2(tmp_path):
    pats_folder(tmp_path / "pats")
    data = prepare(options(tmp_path / "pats", tmp_path / "out"))
    data.check()
    assert [(u.id, u.speaker, u.split, u.frames) for u in data.utterances] == [
        ("000000", "oliver", "train", 150), ("000001", "oliver", "dev", 150),
        ("000002", "lec_law", "test", 150), ("000003", "minhaj", "unseen", 150)]
    assert data.arrays == ("speech", "text", "pose") and data.d_text == 768
    assert len(pats.SEEN) == 16 and len(pats.UNSEEN) == 6
    with pytest.raises(ConvertError, match="no face in the recordings"):
        data.need("face")
    with pytest.raises(ConvertError, match="PATS brings features of its own"):
        prepare(options(tmp_path / "pats", tmp_path / "out", "x.fb"))


def test_pats_index_that_is_none(tmp_path):
    index = tmp_path / "cmu_intervals_df.csv"
    index.write_text("a,b\n1,2\n")
    with pytest.raises(ConvertError, match="line 1: no column dataset"):
        pats.intervals(index)
    index.write_text("dataset,interval_id,speaker\ntrain,1,oliver\n")
    with pytest.raises(ConvertError, match="no interval of Table 6.2's speakers"):
        pats.intervals(index)


def test_the_command_line_says_one_line(tmp_path, capsys):
    for arguments, message in (
            (["prepare", str(tmp_path), "-o", str(tmp_path / "x")], "--front-end: missing"),
            (["corpus", "-o", str(tmp_path / "c"), "--hours", "0"], "--hours: 0.0, expected")):
        assert cli.main(arguments) == 2
        said = capsys.readouterr().err.splitlines()
        assert len(said) == 1 and message in said[0]
    with pytest.raises(ConvertError, match="--infer-cli: /nowhere: No such file"):
        engine.arrays_of("/nowhere", ["features"])
