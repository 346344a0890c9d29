"""Writes the goldens of the C++ tests: tiny networks, their inputs and what PyTorch makes of them.

`/usr/bin/python3 -m converters.goldens` from the root of the repository.  One weights file and one
.npz a case; every alternative reading that the schema has appears in some case.  The cases of a
kind are in the file of its name.
"""

import importlib
import os
import platform

import numpy as np

from .. import VERSION, kinds, networks, weights_file
from ..export import make_self_test
from ..random_weights import random_weights
from .ast import SMALL as AST
from .zs_mstm1 import JOINTS, POSE, SMALL, SPEECH

__all__ = ["AST", "JOINTS", "POSE", "SEED", "SMALL", "SPEECH", "cases", "make_case", "write_all"]

SEED = 20231
# Options of a run, as arrays of one value.
_OPTION_TYPES = {"temperature": np.float32, "top_k": np.int32, "seed": np.int32}


def cases():
    for kind in kinds.KINDS:
        yield from importlib.import_module(f"{__name__}.{kind}").CASES


def make_case(folder, case):
    from ..reference.run import build, run
    network = case.network()
    tensors = random_weights(network, SEED) | case.optional
    module = build(network, tensors)
    inputs = networks.random_inputs(network, SEED, **case.sizes)
    expected = run(module, inputs, taps=True, **case.options)
    expected = {key: x for key, x in expected.items() if not key.startswith(case.untapped or "-")}
    options = {f"option/{name}": np.array([value], _OPTION_TYPES[name])
               for name, value in case.options.items()}
    if case.self_test:
        tensors |= make_self_test(network, module, SEED + 1)
    provenance = {"trained": False, "recipe": f"golden {case.name} ({case.about}), random, seed "
                  f"{SEED}", "licence": "as gestus", "converter": f"gestus converters {VERSION}"}
    weights_file.write(os.path.join(folder, case.name + ".fb"), [network], tensors, provenance)
    write_npz(os.path.join(folder, case.name + ".npz"), inputs | options | expected)


def write_npz(path, arrays):
    """np.savez, whose members carry no time of day: the same arrays give the same bytes."""
    with open(path, "wb") as file:
        np.savez(file, **arrays)


def write_all(folder):
    import torch
    os.makedirs(folder, exist_ok=True)
    lines = []
    for case in cases():
        make_case(folder, case)
        lines.append(f"| {case.name} | {case.about} |")
    readme = README.format(seed=SEED, python=platform.python_version(), numpy=np.__version__,
                           torch=torch.__version__, table="\n".join(lines))
    with open(os.path.join(folder, "README.md"), "w", encoding="utf-8") as file:
        file.write(readme)


README = """# Goldens

Tiny networks with random weights, their inputs, and what PyTorch's reference (converters/reference,
in double precision) makes of them, layer by layer.  The C++ tests read them; they need no PyTorch.

`<case>.fb` is the weights file.  `<case>.npz` holds the inputs and the outputs under the names that
infer-cli gives them, and intermediates as `tap/<name>`: float32, whole numbers int32.  Where
several windows share an intermediate it is the last one's, or left out.  `option/<name>` is an
option of the run that made the outputs.

Made by `/usr/bin/python3 -m converters.goldens`, seed {seed}, Python {python}, NumPy {numpy},
PyTorch {torch}.  Running it again gives the same bytes.

| case | about |
|---|---|
{table}
"""
