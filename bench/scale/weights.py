"""Random weights of full size in out/scale, and inputs of any length for them."""

import json
import subprocess
import sys

import numpy as np

NETWORKS = {"ast": "AST base, 64 frames", "bert": "BERT base, 32 tokens",
            "zs_mstm1": "ZS-MSTM 1.0, segment, style kept"}
TYPES = ("fp32", "bf16", "int8")


def make(folder, network, kind):
    """The file, made once."""
    path = folder / f"{network}.{kind}.fb"
    if path.exists():
        return path
    folder.mkdir(parents=True, exist_ok=True)
    if kind == "fp32":
        config = folder / f"{network}.json"
        config.write_text(json.dumps({}))
        _converters("random", "--kind", network, "--no-self-test", "--config", config, "-o", path)
    else:
        _converters("quantise", "--to", kind, "--unchecked", make(folder, network, "fp32"), "-o",
                    path)
    return path


def speech(folder, minutes):
    """An input of so many minutes for ZS-MSTM 1.0, with a clip of the speaker."""
    path = folder / f"speech{minutes}.npz"
    if not path.exists():
        frames = int(minutes * 60 * 15)
        random = np.random.default_rng(1)
        np.savez(path, speech=random.normal(-4, 2, (frames, 128)).astype(np.float32),
                 text=random.normal(0, 0.3, (frames, 768)).astype(np.float16),
                 style_speech=random.normal(-4, 2, (64, 128)).astype(np.float32),
                 style_text=random.normal(0, 0.3, (64, 768)).astype(np.float32),
                 style_pose=random.normal(0, 1, (64, 22)).astype(np.float32))
    return path


def _converters(*arguments):
    subprocess.run([sys.executable, "-m", "converters", *map(str, arguments)], check=True,
                   stdout=subprocess.DEVNULL)
