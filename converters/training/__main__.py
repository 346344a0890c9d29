#!/usr/bin/python3
"""The command line of training; each part adds its own commands."""

import argparse
import sys

from ..errors import ConvertError
from . import commands as training
from . import recipe
from .corpus import command as corpus
from .data import command as prepare
from .evidence import command as evidence

# Modules with add(commands); the options of a command have .run(options).
PARTS = (corpus, prepare, training, evidence, recipe)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python3 -m converters.training", description=__doc__)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for part in PARTS:
        part.add(commands)
    options = parser.parse_args(arguments)
    try:
        return options.run(options) or 0
    except ConvertError as error:
        message = str(error)
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    # One line of printable characters, whatever a file's content put into it.
    print("training: " + "".join(c if c.isprintable() else "?" for c in message), file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
