"""How each kind of network is trained: one file each, with a class Task."""

import importlib
import pkgutil

TASKS = tuple(info.name for info in pkgutil.iter_modules(__path__) if info.name != "task")


def of(name):
    return importlib.import_module(f"{__name__}.{name}").Task
