"""Runs infer-cli: what its commands write, as arrays."""

import pathlib
import subprocess
import tempfile

import numpy as np

from ..errors import ConvertError

DEFAULT = "build/release/bin/infer-cli"


def arrays_of(infer_cli, arguments):
    """{array} that `infer-cli ARGUMENTS -o FILE.npz` writes; its error line becomes ours."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "out.npz"
        try:
            done = subprocess.run([infer_cli, *map(str, arguments), "-o", str(output)],
                                  capture_output=True, text=True, check=False)
        except OSError as error:
            raise ConvertError(f"--infer-cli: {infer_cli}: {error.strerror}, expected the program "
                               "that `./run test` builds") from None
        if done.returncode != 0:
            raise ConvertError(done.stderr.strip().splitlines()[-1][:400] if done.stderr.strip()
                               else f"{infer_cli}: exit code {done.returncode}")
        with np.load(output) as file:
            return dict(file)
