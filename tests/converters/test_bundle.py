"""Several networks in one file."""

import numpy as np
import pytest

from converters import goldens, weights_file
from converters.__main__ import main
from converters.goldens import bert, classifier, discriminator

pytest.importorskip("torch")


@pytest.fixture
def files(tmp_path):
    """Goldens as source files: case -> path."""
    cases = {"bert": bert.CASES[3], "classifier": classifier.CASES[0],
             "discriminator": discriminator.CASES[0]}
    for case in cases.values():
        goldens.make_case(str(tmp_path), case)
    return {kind: str(tmp_path / f"{case.name}.fb") for kind, case in cases.items()}


def rewrite(path, **provenance):
    file = weights_file.read(path)
    weights_file.write(path, file.networks, dict(file.tensors), {**file.provenance, **provenance})


def test_networks_keep_what_they_have(files, tmp_path):
    out = str(tmp_path / "out.fb")
    assert main(["bundle", *files.values(), "-o", out]) == 0
    together = weights_file.read(out)
    assert [n["name"] for n in together.networks] == list(files)
    for network, path in zip(together.networks, files.values()):
        alone = weights_file.read(path)
        before = alone.networks[0]
        assert network["prefix"] == network["name"] + "/"
        assert network["config"] == before["config"]
        assert network.get("normalisations") == before.get("normalisations")
        tensors = together.network_tensors(network)
        assert tensors.keys() == alone.network_tensors(before).keys()
        for key, want in alone.tensors.items():
            np.testing.assert_array_equal(together.tensors[network["prefix"] + key], want)
        test = network["self_test"]
        assert {*test["inputs"], test["output"]} <= {*together.tensors}
        assert test["input_names"] == before["self_test"]["input_names"]
    assert "vocabulary" in together.network_tensors(together.networks[0])


def test_bundles_can_be_bundled_and_are_deterministic(files, tmp_path):
    two, three, once = (str(tmp_path / name) for name in ("2.fb", "3.fb", "1.fb"))
    assert main(["bundle", f"acts={files['bert']}", files["classifier"], "-o", two]) == 0
    assert main(["bundle", two, files["discriminator"], "-o", three]) == 0
    assert main(["bundle", f"acts={files['bert']}", files["classifier"], files["discriminator"],
                 "-o", once]) == 0
    a, b = weights_file.read(three), weights_file.read(once)
    assert a.networks == b.networks and list(a.tensors) == list(b.tensors)
    assert [n["name"] for n in a.networks] == ["acts", "classifier", "discriminator"]
    again = str(tmp_path / "again.fb")
    assert main(["bundle", two, files["discriminator"], "-o", again]) == 0
    assert (tmp_path / "again.fb").read_bytes() == (tmp_path / "3.fb").read_bytes()


def test_provenance(files, tmp_path):
    out = str(tmp_path / "out.fb")
    rewrite(files["bert"], trained=True, trained_on="books", source="bert.bin sha256:12")
    rewrite(files["classifier"], trained=True, recipe="r", licence="MIT")
    main(["bundle", files["bert"], files["classifier"], "-o", out])
    p = weights_file.read(out).provenance
    assert p["trained"] and p["trained_on"] == "bert: books"
    assert p["licence"] == "bert: as gestus; classifier: MIT"
    checksum = weights_file.read(files["bert"]).header["checksum"]
    assert f"bert: bert_vocabulary.fb checksum:{checksum:016x} (bert.bin sha256:12)" in p["source"]
    rewrite(files["discriminator"], trained=True, trained_on="books")
    main(["bundle", files["bert"], files["classifier"], files["discriminator"], "-o", out])
    assert weights_file.read(out).provenance["trained_on"] == "bert, discriminator: books"
    rewrite(files["discriminator"], trained=False)
    main(["bundle", files["bert"], files["discriminator"], "-o", out])
    p = weights_file.read(out).provenance
    assert not p["trained"] and p["recipe"].startswith("untrained: discriminator; bert: golden")
    assert p["licence"] == "as gestus"


@pytest.mark.parametrize("sources, message", [
    (("{bert}", "{bert}"), "network bert is in"),
    (("a={bert}", "a={classifier}"), "NAME=FILE gives another name"),
    (("{bert}", "none.fb"), "none.fb: No such file"),
    (("a={two}",), "2 networks, expected one to rename"),
])
def test_refused(files, tmp_path, capfd, sources, message):
    two = str(tmp_path / "two.fb")
    main(["bundle", files["bert"], files["classifier"], "-o", two])
    sources = [source.format(**files, two=two) for source in sources]
    assert main(["bundle", *sources, "-o", str(tmp_path / "out.fb")]) == 2
    error = capfd.readouterr().err
    assert message in error and error.count("\n") == 1
    assert not (tmp_path / "out.fb").exists()
