"""Vocabulary and labels that travel with BERT."""

import json

import pytest

torch = pytest.importorskip("torch")

from converters import networks, weights_file  # noqa: E402
from converters.__main__ import main  # noqa: E402
from converters.errors import ConvertError  # noqa: E402
from converters.random_weights import random_weights, save_checkpoint  # noqa: E402
from converters.vocabulary import DIALOG_TAGS, read_labels, read_vocabulary  # noqa: E402

WORDS = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", "a", "##b", "\u2028", "é", "##\x85"]
CONFIG = {"layers": 1, "d_model": 8, "heads": 2, "d_mlp": 8, "tokens": len(WORDS), "positions": 5,
          "head": "Classifier"}


@pytest.fixture
def write(tmp_path):
    def write(content):
        path = tmp_path / "lines.txt"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)
    return write


@pytest.mark.parametrize("text", ["\n".join(WORDS), "\n".join(WORDS) + "\n",
                                  "\r\n".join(WORDS) + "\r\n"])
def test_vocabulary(write, text):
    assert bytes(read_vocabulary(write(text), len(WORDS))) == "\n".join(WORDS).encode()


@pytest.mark.parametrize("content, message", [
    ("\n".join(WORDS[:-1]), "8 lines, expected 9 as in config.tokens"),
    ("\n".join(WORDS) + "\n\n", "line 10 is empty"),
    ("", "0 lines"),
    ("\n".join(WORDS[:4] + ["a"] * 5), "line 6 repeats the token of line 5"),
    ("\n".join(["x" if x == "[SEP]" else x for x in WORDS]), r"\[SEP\] is missing"),
    ("\n".join(["x" if x == "[UNK]" else x for x in WORDS]), r"\[UNK\] is missing"),
    ("\n".join(WORDS[1:] + WORDS[:1]), r"\[PAD\] in line 9, expected it in the first"),
    (b"[PAD]\n\xff", "no UTF-8 at byte 6"),
    (b"x" * ((16 << 20) + 1), "more than 16777216 bytes"),
])
def test_vocabularies_that_are_refused(write, content, message):
    with pytest.raises(ConvertError, match=message):
        read_vocabulary(write(content), len(WORDS))


def test_labels(write):
    assert read_labels(write("yes\nno\n")) == ["yes", "no"]
    assert read_labels(write("yes|1\nno|0\n")) == ["no", "yes"]
    lines = [f"Name of {tag}|{tag}" for tag in DIALOG_TAGS] + ["Uninterpretable|%"]
    assert read_labels(write("\n".join(reversed(lines)))) == [f"Name of {t}" for t in DIALOG_TAGS]


@pytest.mark.parametrize("text, message", [
    ("", "empty"), ("a|1\nb\n", "some are not"), ("a|sd\nb|sv", "of class 0 is missing"),
    ("a|0\nb|0", "tag '0' is there twice")])
def test_labels_that_are_refused(write, text, message):
    with pytest.raises(ConvertError, match=message):
        read_labels(write(text))


def test_both_in_a_weights_file(tmp_path, capfd):
    labels = ["yes", "no", "perhaps"]
    network = networks.complete("bert", {"config": {**CONFIG, "labels": labels}})
    save_checkpoint(tmp_path / "m.pt", random_weights(network, 1))
    (tmp_path / "c.json").write_text(json.dumps({**CONFIG, "prefix": "acts/"}))
    (tmp_path / "vocab.txt").write_text("\n".join(WORDS))
    (tmp_path / "labels.txt").write_text("\n".join(labels))
    arguments = ["export", str(tmp_path / "m.pt"), "-o", str(tmp_path / "m.fb"), "--vocabulary",
                 str(tmp_path / "vocab.txt"), "--labels", str(tmp_path / "labels.txt")]
    assert main([*arguments, "--kind", "bert", "--config", str(tmp_path / "c.json")]) == 0
    file = weights_file.read(str(tmp_path / "m.fb"))
    assert bytes(file.tensors["acts/vocabulary"]) == "\n".join(WORDS).encode()
    assert file.networks[0]["config"]["labels"] == labels and "self_test" in file.networks[0]
    assert main(["inspect", str(tmp_path / "m.fb")]) == 0
    assert main(arguments) == 2
    assert "--labels: kind zs_mstm1, expected bert" in capfd.readouterr().err
