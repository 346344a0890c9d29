"""Makes the package importable from its source tree; tiny networks, and what several tests share."""

import json
import pathlib
import sys

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

# pylint: disable=wrong-import-position
from converters import goldens, networks, weights_file  # noqa: E402
from converters.__main__ import main  # noqa: E402
from converters.random_weights import random_weights  # noqa: E402


@pytest.fixture
def tiny():
    """A completed ZS-MSTM 1.0 network of tiny geometry, with two ASTs."""
    config = {**goldens.SMALL, "ast_shared": False}
    return networks.complete("zs_mstm1", {"config": config, "joints": goldens.JOINTS,
                                          "normalisations": [goldens.SPEECH, goldens.POSE]})


@pytest.fixture
def tiny_config(tmp_path):
    """The same as a file for --config."""
    path = tmp_path / "config.json"
    path.write_text(json.dumps({**goldens.SMALL, "ast_shared": False, "joints": goldens.JOINTS,
                                "normalisations": [goldens.SPEECH, goldens.POSE]}))
    return path


@pytest.fixture
def export(tmp_path, capfd):
    """Runs `export`; gives the exit code, the tensors (if any) and what was said."""
    def export(path, kind, config, *options):
        file, output = tmp_path / "config.json", tmp_path / "out.fb"
        file.write_text(json.dumps(config))
        code = main(["export", str(path), "--kind", kind, "--config", str(file), "-o", str(output),
                     "--no-self-test", *map(str, options)])
        said = capfd.readouterr()
        tensors = weights_file.read(str(output)).tensors if code == 0 else None
        return code, tensors, said.out + said.err
    return export


def weights(kind, config):
    """Random tensors of a network by their names."""
    return random_weights(networks.complete(kind, {"config": config}), 1)


def same(tensors, want):
    assert list(tensors) == list(want)
    for key, x in want.items():
        np.testing.assert_array_equal(tensors[key], x)
