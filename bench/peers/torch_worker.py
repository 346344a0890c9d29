"""PyTorch's end of the pipe (workers.py): torch_worker.py FOLDER MODEL.pt THREADS."""

import gc
import json
import pathlib
import sys
import time

import numpy as np
import torch

# The profiling executor rewrites the graph in the first runs.
WARM_UP = 3


def main(folder, path, threads):
    torch.set_num_threads(int(threads))
    torch.set_num_interop_threads(1)
    folder = pathlib.Path(folder)
    inputs = [torch.from_numpy(np.fromfile(folder / f"{name}.bin", x["type"]).reshape(x["shape"]))
              for name, x in json.loads((folder / "case.json").read_text())["inputs"].items()]
    model = torch.jit.optimize_for_inference(torch.jit.freeze(torch.jit.load(path).eval()))
    output = model(*inputs)
    print("ready", flush=True)
    for _ in range(WARM_UP):
        output = model(*inputs)
    gc.disable()
    for line in sys.stdin:
        request, argument = line.rstrip("\n").split(" ", 1)
        if request == "run":
            times = []
            for _ in range(int(argument)):
                start = time.monotonic_ns()
                output = model(*inputs)
                times.append(time.monotonic_ns() - start)
            print(*times, flush=True)
        else:
            outputs = output if isinstance(output, tuple) else (output,)
            np.concatenate([x.numpy().astype(np.float32).ravel() for x in outputs]).tofile(argument)
            print("written", flush=True)


if __name__ == "__main__":
    with torch.no_grad():
        main(*sys.argv[1:])
