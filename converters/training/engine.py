"""Runs infer-cli: what its commands write, as arrays, and what they say."""

import json
import pathlib
import subprocess
import tempfile

import numpy as np

from ..errors import ConvertError

DEFAULT = "build/release/bin/infer-cli"


def arrays_of(infer_cli, arguments):
    """({array}, report) of `infer-cli ARGUMENTS --json -o FILE.npz`; its error becomes ours."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "out.npz"
        command = [infer_cli, *map(str, arguments), "--json", "-o", str(output)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError as error:
            raise ConvertError(f"--infer-cli: {infer_cli}: {error.strerror}, expected the program "
                               "that `./run demo` builds") from None
        if done.returncode != 0:
            said = done.stderr.strip().splitlines()
            raise ConvertError(said[-1][:400] if said
                               else f"{infer_cli}: exit code {done.returncode}")
        with np.load(output) as file:
            return dict(file), json.loads(done.stdout)
