"""Makes the models of other types from those that export.py wrote: the same weights in fewer bits.

usage: python3 -m bench.peers.narrow FOLDER CASE...   -> FOLDER/<case>/
  gestus.bf16.fb  gestus.int8.fb    every matrix that a product reads, and the embeddings
  torch.bf16.pt   torch.int8.pt     the whole module; its linear layers and LSTMs (torch_types.py)
  ort.int8.onnx                     its products, LSTMs and embeddings (ort_int8.py)

Files that are there stay.  ONNX Runtime's processor kernels know no bf16.
"""

import importlib.util
import json
import pathlib
import sys

import numpy as np
import torch

from converters import networks, weights_file
from converters.quantise import narrowed, read_by_products

from . import modules, torch_types
from .cases import CASES
from .export import save_traced

_HAS_ONNX = importlib.util.find_spec("onnx") is not None
if _HAS_ONNX:
    from . import ort_int8


def narrow(folder, case):
    for kind in ("bf16", "int8"):
        _make(folder / f"gestus.{kind}.fb", lambda path, kind=kind: _gestus(folder, kind, path))
        _make(folder / f"torch.{kind}.pt", lambda path, kind=kind: _torch(folder, case, kind, path))
    if _HAS_ONNX:
        _make(folder / "ort.int8.onnx",
              lambda path: ort_int8.quantise(folder / "ort.fp32.onnx", path))


def _make(path, write):
    """All or nothing, and only what is missing."""
    if not path.exists():
        unfinished = path.with_name("unfinished." + path.name)
        print(f"==> making {path.parent.name}/{path.name}", file=sys.stderr, flush=True)
        write(unfinished)
        unfinished.rename(path)


def _gestus(folder, kind, path):
    file = weights_file.read(folder / "gestus.fp32.fb")
    [network] = file.networks
    prefix = len(network["prefix"])
    tensors = {name: narrowed(tensor, kind) if read_by_products(name[prefix:], tensor) else tensor
               for name, tensor in file.tensors.items()}
    recipe = f"{file.provenance['recipe']}; weights in {kind}"
    weights_file.write(path, [network], tensors, {**file.provenance, "recipe": recipe})


def _torch(folder, case, kind, path):
    network = networks.complete(case.kind, {"config": case.config})
    file = weights_file.read(folder / "gestus.fp32.fb")
    arrays = {key: np.array(x) for key, x in file.network_tensors(file.networks[0]).items()}
    module = getattr(modules, case.part)(network, arrays).float()
    described = json.loads((folder / "case.json").read_text())["inputs"]
    tensors = tuple(torch.from_numpy(np.fromfile(folder / f"{name}.bin", x["type"])
                                     .reshape(x["shape"])) for name, x in described.items())
    save_traced(torch_types.MAKERS[kind](module), tensors, path)


def main(folder, *names):
    if not _HAS_ONNX:
        print("==> python3-onnx is not installed: no int8 for ONNX Runtime", file=sys.stderr)
    modules.fix_constants()
    for case in CASES:
        if case.name in names:
            narrow(pathlib.Path(folder) / case.name, case)


if __name__ == "__main__":
    main(*sys.argv[1:])
