"""Runs goldens.write_all."""

import sys

from . import write_all

write_all(*(sys.argv[1:] or ["tests/goldens"]))
