"""Runs the demo; `./run demo` builds infer-cli and calls this."""

import argparse
import pathlib
import subprocess
import sys

from ..errors import ConvertError
from . import full_size, trained
from .steps import ROOT, shown


def main():
    parser = argparse.ArgumentParser(prog="./run demo", description=__doc__)
    parser.add_argument("--infer-cli", required=True)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--output", default=str(ROOT / "out" / "demo"), metavar="FOLDER")
    parser.add_argument("--full-size", action="store_true",
                        help="the network of the thesis at full size, with random weights")
    options = parser.parse_args()
    out = pathlib.Path(options.output)
    out.mkdir(parents=True, exist_ok=True)
    try:
        (full_size if options.full_size else trained).demo(options, out)
    except ConvertError as error:
        sys.exit(f"demo: {error}")
    except subprocess.CalledProcessError as error:
        sys.exit(f"demo: {shown(error.cmd[0])} failed")


if __name__ == "__main__":
    main()
