"""The file that says how a model is trained, one JSON object a model; configs/ has those of the thesis
and of the demo.

    kind        a task of tasks/: a kind of network, or `acts`
    about       one line for people
    network     as `python3 -m converters export --config` takes it; widths that follow from the data
                set (d_text, mel_bins, normalisations, ...) are filled in
    options     of the task: weights of losses, what of the data is used
    optimiser   name and what PyTorch's class takes
    schedule    name and numbers of a schedule of schedules.py
    batch       items of a step
    epochs      or `steps`: when training ends
    clip        largest norm of the gradients, or null
    dev_every   steps from one look at the development split to the next
    seed        0 or more
    provenance  trained_on, licence, recipe: what the weights file says of itself
"""

import json
import pathlib

from .. import strict_json
from ..errors import ConvertError
from . import optimiser, schedules, tasks

_DEFAULTS = {"about": "", "network": {}, "options": {}, "clip": None, "dev_every": 200, "seed": 1,
             "provenance": {}}
_NEEDED = ("kind", "optimiser", "schedule", "batch")
_LENGTHS = ("epochs", "steps")
_PROVENANCE = ("trained_on", "licence", "recipe")


def read(path, changes=()):
    """The checked configuration in `path`, with defaults.  `changes`: "FIELD=JSON" of fields that are
    set otherwise, those inside objects as "options.dropout"."""
    path = pathlib.Path(path)
    found = strict_json.parse(path.read_bytes(), str(path))
    for text in changes:
        _change(found, text)
    return check(found, str(path))


def _change(found, text):
    field, equals, value = text.partition("=")
    *outer, name = field.split(".")
    if not equals or not name:
        raise ConvertError(f"--set: {text}, expected FIELD=JSON")
    for part in outer:
        found = found.setdefault(part, {}) if isinstance(found, dict) else None
    if not isinstance(found, dict):
        raise ConvertError(f"--set: {text}: {'.'.join(outer)} is no object")
    found[name] = strict_json.parse(value.encode(), f"--set: {field}")


def check(given, where):
    if not isinstance(given, dict):
        raise ConvertError(f"{where}: expected an object with kind, network, optimiser, schedule, ...")
    _names(given, {*_DEFAULTS, *_NEEDED, *_LENGTHS}, where)
    for name in _NEEDED:
        if name not in given:
            raise ConvertError(f"{where}: {name} is missing")
    if sum(name in given for name in _LENGTHS) != 1:
        raise ConvertError(f"{where}: expected either epochs or steps")
    found = {**_DEFAULTS, **given}
    for name in ("batch", "dev_every", *(name for name in _LENGTHS if name in found)):
        _count(found[name], f"{where}: {name}", 1)
    _count(found["seed"], f"{where}: seed", 0)
    for name in ("network", "options", "provenance"):
        if not isinstance(found[name], dict):
            raise ConvertError(f"{where}: {name}: {_shown(found[name])}, expected an object")
    if found["kind"] not in tasks.TASKS:
        raise ConvertError(f"{where}: kind: {_shown(found['kind'])}, expected one of "
                           + ", ".join(tasks.TASKS))
    _names(found["provenance"], _PROVENANCE, f"{where}: provenance")
    if found["clip"] is not None and not (_number(found["clip"]) and found["clip"] > 0):
        raise ConvertError(f"{where}: clip: {_shown(found['clip'])}, expected a number above 0")
    optimiser.check(found["optimiser"], f"{where}: optimiser")
    schedules.check(found["schedule"], f"{where}: schedule")
    found["options"] = _options(found, tasks.of(found["kind"]).options, f"{where}: options")
    return found


def _options(found, defaults, where):
    _names(found["options"], defaults, where)
    for name, value in found["options"].items():
        wanted = defaults[name]
        alike = (_number(value) if _number(wanted) else type(value) is type(wanted))
        if not alike:
            raise ConvertError(f"{where}: {name}: {_shown(value)}, expected "
                               + ("a number" if _number(wanted) else
                                  f"what is like {json.dumps(wanted)}"))
    return {**defaults, **found["options"]}


def _names(given, known, where):
    for name in given:
        if name not in known:
            raise ConvertError(f"{where}: {_shown(name)} is no field, expected some of "
                               + ", ".join(sorted(known)))


def _count(value, where, least):
    if type(value) is not int or value < least:
        raise ConvertError(f"{where}: {_shown(value)}, expected a whole number of at least {least}")


def _number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _shown(value):
    return json.dumps(value)[:40]
