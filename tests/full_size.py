#!/usr/bin/python3
"""Every network at full size against PyTorch, on every instruction set of this machine.

Makes random weights from a fixed seed, exports them, and compares the engine's outputs and taps with
the reference modules (python3 -m converters verify): relative error of each output <= 1e-4.
Usage: full_size.py INFER_CLI WORK_FOLDER
"""

import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
NETWORKS = {
    # name: (kind, configuration beyond the defaults)
    "zs_mstm1_autoregressive": ("zs_mstm1", {"decoder_mode": "Autoregressive"}),
    "zs_mstm1_shifted": ("zs_mstm1", {"decoder_mode": "ShiftedParallel"}),
    "zs_mstm1_parallel": ("zs_mstm1", {"decoder_mode": "Parallel"}),
    "zs_mstm2": ("zs_mstm2", {}),
    "ast": ("ast", {}),
    "bert": ("bert", {}),
    "distilbert": ("bert", {"layers": 6, "types": 0, "head": "Classifier"}),
    "ae_speech": ("autoencoder", {"length": 100}),
    "ae_face": ("autoencoder", {"length": 124}),
    "model1": ("model1", {}),
    "model2": ("model2", {}),
    "model2_speech": ("model2", {"master": "Speech"}),
    "classifier": ("classifier", {}),
    "discriminator": ("discriminator", {}),
}


def run(*command, **environment):
    subprocess.run([str(c) for c in command], check=True, cwd=ROOT,
                   env={**os.environ, **environment})


def isas(infer_cli):
    text = subprocess.run([infer_cli, "--version", "--json"], check=True, capture_output=True,
                          text=True).stdout
    return json.loads(text)["available_isas"]


def check(infer_cli, work, name, kind, config, available):
    weights, checkpoint = work / f"{name}.fb", work / f"{name}.pt"
    config_file = work / f"{name}.json"
    config_file.write_text(json.dumps(config))
    run(sys.executable, "-m", "converters", "random", "--kind", kind, "--seed", 20231, "--config",
        config_file, "-o", weights, "--checkpoint-out", checkpoint)
    for isa in available:
        run(infer_cli, "check", weights, GESTUS_ISA=isa)
    print(f"== {name}", flush=True)
    run(sys.executable, "-m", "converters", "verify", weights, "--checkpoint", checkpoint,
        "--infer-cli", infer_cli, "--isas", ",".join(available))
    weights.unlink()
    checkpoint.unlink()


def main():
    infer_cli, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    available = isas(infer_cli)
    for name, (kind, config) in NETWORKS.items():
        check(infer_cli, work, name, kind, config, available)
    print("full size agrees with PyTorch on " + ", ".join(available))


if __name__ == "__main__":
    main()
