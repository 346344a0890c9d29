"""Tensors of fewer than 32 bits an element, as weights files hold them."""

import numpy as np

from .errors import ConvertError


class Quantised:
    """`dtype` "BF16": `values` are the upper halves of float32, as uint16.  "I8": `values` are int8
    of -127 to 127 and `scale` (rows,) float32 is what each row of the first axis is multiplied
    with."""

    def __init__(self, dtype, values, scale=None):
        self.dtype, self.values, self.scale = dtype, values, scale

    @property
    def shape(self):
        return self.values.shape

    @property
    def nbytes(self):
        return self.values.nbytes + (0 if self.scale is None else self.scale.nbytes)

    def float32(self):
        if self.dtype == "BF16":
            return (self.values.astype(np.uint32) << 16).view(np.float32)
        return self.values.astype(np.float32) * _by_row(self.scale, self.values.ndim)

    def check(self, name, max_depth, where=""):
        """Raises ConvertError for what the engine would refuse."""
        where = f"{where}tensor {name}: "
        if self.dtype == "BF16":
            if (self.values & 0x7f80 == 0x7f80).any():
                raise ConvertError(where + "holds NaN or infinity, expected finite weights")
            return
        rows = self.shape[0] if self.values.ndim >= 2 else 0
        if rows == 0:
            raise ConvertError(where + "I8 with fewer than two dimensions")
        if self.values.size // rows > max_depth:
            raise ConvertError(where + f"rows of {self.values.size // rows} I8 elements, expected "
                               f"at most {max_depth}")
        if (self.values == -128).any():
            raise ConvertError(where + "holds -128, expected -127 to 127")
        scale = self.scale
        if scale is None or scale.shape != (rows,) or scale.dtype != np.float32:
            raise ConvertError(where + f"expected ({rows},) float32 scales")
        if not (np.isfinite(scale) & (scale > 0)).all():
            raise ConvertError(where + "holds scales that are not finite and above zero")


def to_bf16(array):
    """The nearest bf16 of each element, ties to even; of the largest ones, the largest."""
    bits = np.ascontiguousarray(array, np.float32).view(np.uint32).astype(np.uint64)
    upper = ((bits + 0x7fff + (bits >> 16 & 1)) >> 16).astype(np.uint16)
    overflown = upper & 0x7fff == 0x7f80
    return Quantised("BF16", np.where(overflown, upper - np.uint16(1), upper))


def to_int8(array):
    """round(x / scale) with scale = max |row| / 127; a row without weights gets scale 1."""
    array = np.asarray(array, np.float32)
    largest = np.abs(array).reshape(len(array), -1).max(axis=1)
    scale = np.maximum(largest / np.float32(127), np.finfo(np.float32).tiny).astype(np.float32)
    scale[largest == 0] = 1
    values = np.rint(array / _by_row(scale, array.ndim)).clip(-127, 127).astype(np.int8)
    return Quantised("I8", values, scale)


def _by_row(scale, rank):
    return scale.reshape(-1, *(1,) * (rank - 1))
