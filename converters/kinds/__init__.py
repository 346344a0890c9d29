"""The kinds of networks, by the names that the command line gives them: one file each."""

import importlib
import pkgutil

from ..errors import ConvertError

KINDS = {info.name: importlib.import_module(f"{__name__}.{info.name}").KIND
         for info in pkgutil.iter_modules(__path__)}


def kind_of(network):
    """The name of the kind of `network`."""
    for name, kind in KINDS.items():
        if network["config_type"] == kind.config_type:
            return name
    raise ConvertError(f"network {network['name']}: kind {network['config_type']}, expected one of "
                       + ", ".join(kind.config_type for kind in KINDS.values()))


def of(network):
    """What is known of the kind of `network`."""
    return KINDS[kind_of(network)]
