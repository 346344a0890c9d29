"""PyTorch reference networks: the oracle that the engine is compared with.

Written to be read beside the thesis, not to be fast.  Sequences are (rows, columns) without a batch
dimension.  `tap(name, tensor)` is called with every intermediate that the engine can show too.
"""
