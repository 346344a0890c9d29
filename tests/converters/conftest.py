"""Makes the package importable from its source tree, and tiny networks for the tests."""

import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from converters import goldens, networks  # noqa: E402  pylint: disable=wrong-import-position


@pytest.fixture
def tiny():
    """A completed ZS-MSTM 1.0 network of tiny geometry, with two ASTs."""
    config = {**goldens.SMALL, "ast_shared": False}
    return networks.complete("zs_mstm1", {"config": config, "joints": goldens.JOINTS,
                                          "normalisations": [goldens.SPEECH, goldens.POSE]})


@pytest.fixture
def tiny_config(tmp_path):
    """The same as a file for --config."""
    import json
    path = tmp_path / "config.json"
    path.write_text(json.dumps({**goldens.SMALL, "ast_shared": False, "joints": goldens.JOINTS,
                                "normalisations": [goldens.SPEECH, goldens.POSE]}))
    return path
