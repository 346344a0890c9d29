"""Joins weights files into one that holds all their networks."""

import os
import re

from . import VERSION, weights_file
from .errors import ConvertError

_NAME = re.compile(r"[\w.-]+", re.ASCII)


def bundle(sources, path):
    """Writes the networks of `sources` ("FILE", or "NAME=FILE" to rename the only network of a
    file) to `path`; the tensors of each get the prefix "<its name>/".  Returns lines to report."""
    networks, tensors, origins = [], {}, {}
    for source in sources:
        name, file_path = _split(source)
        file = weights_file.read(file_path)
        if name is not None and len(file.networks) != 1:
            raise ConvertError(f"{source}: {len(file.networks)} networks, expected one to rename")
        owners = _owners(file, file_path)
        for network in file.networks:
            new_name = name or network["name"]
            if not _NAME.fullmatch(new_name):
                raise ConvertError(f"{file_path}: network {new_name}: expected a name of letters, "
                                   "digits, '_', '.' and '-'; NAME=FILE gives another")
            if new_name in origins:
                raise ConvertError(f"{file_path}: network {new_name} is in "
                                   f"{origins[new_name].path} too; NAME=FILE gives another name")
            origins[new_name] = _Origin(file_path, file)
            owned = [key for key, owner in owners.items() if owner is network]
            renamed = {key: f"{new_name}/{key[len(network['prefix']):]}" for key in owned}
            tensors |= {renamed[key]: file.tensors[key] for key in owned}
            networks.append(_renamed(network, new_name, renamed))
    weights_file.write(path, networks, tensors, _provenance(origins))
    return [f"network {name}: from {origin.path}" for name, origin in origins.items()]


class _Origin:
    """Where a network comes from."""

    def __init__(self, path, file):
        self.path = path
        self.provenance = file.provenance
        self.source = f"{os.path.basename(path)} checksum:{file.header['checksum']:016x}"
        if "source" in file.provenance:
            self.source += f" ({file.provenance['source']})"


def _split(source):
    """NAME or None, and FILE."""
    name, equals, path = source.partition("=")
    return (name, path) if equals and _NAME.fullmatch(name) else (None, source)


def _owners(file, path):
    """Tensor -> the network whose prefix it has."""
    owners = {}
    for key in file.tensors:
        found = [network for network in file.networks if key.startswith(network["prefix"])]
        if len(found) != 1:
            raise ConvertError(f"{path}: tensor {key}: belongs to {len(found)} networks, expected "
                               "one")
        owners[key] = found[0]
    return owners


def _renamed(network, name, tensors):
    """`network` under another name; `tensors` says what its tensors are called now."""
    network = {**network, "name": name, "prefix": name + "/"}
    if "self_test" in network:
        test = network["self_test"]
        network["self_test"] = {**test, "inputs": [tensors[key] for key in test["inputs"]],
                                "output": tensors[test["output"]]}
    return network


def _provenance(origins):
    """Trained only if every network is; what they do not agree on is said of each."""
    trained = {name: origin.provenance["trained"] for name, origin in origins.items()}
    provenance = {"trained": all(trained.values()), "converter": f"gestus converters {VERSION}",
                  "source": _said({name: origin.source for name, origin in origins.items()})}
    for field in ("trained_on", "trained_at", "recipe", "licence"):
        values = {name: origin.provenance[field] for name, origin in origins.items()
                  if field in origin.provenance}
        if values:
            agreed = len(values) == len(origins) and len({*values.values()}) == 1
            provenance[field] = next(iter(values.values())) if agreed else _said(values)
    if any(trained.values()) and not provenance["trained"]:
        untrained = [name for name, is_trained in trained.items() if not is_trained]
        provenance["recipe"] = "; ".join(filter(None, (
            f"untrained: {', '.join(untrained)}", provenance.get("recipe"))))
    return provenance


def _said(values):
    """"NAME, NAME: TEXT; NAME: TEXT", each text once."""
    names = {}
    for name, value in values.items():
        names.setdefault(value, []).append(name)
    return "; ".join(f"{', '.join(who)}: {value}" for value, who in names.items())
