"""Turns checkpoints into gestus weights files and compares the engine with PyTorch.

`python3 -m converters --help` lists the commands.  `export`, `random` and `inspect` need NumPy,
xxhash and flatc, and h5py for Keras' files; PyTorch is imported only where its reference networks
run.
"""

VERSION = "0.1.0"
