"""Mean and deviation of the training split: what x' = (x - mean) / (2 deviation) brings to mean 0 and
deviation 0.5 (thesis 6.6)."""

import numpy as np

# Columns that stand still, such as a neck at 0, would be divided by nothing.
_STILL = 1e-3


def of(stream, arrays, by_column):
    """The normalisation of a network's stream over `arrays` (rows, columns), of each column or of all
    numbers together, as the schema has it."""
    rows = np.concatenate(list(arrays)).astype(np.float64)
    axis = 0 if by_column else None
    mean, deviation = np.atleast_1d(rows.mean(axis)), np.atleast_1d(rows.std(axis))
    deviation = np.where(deviation < _STILL, 1.0, deviation)
    return {"stream": stream, "mean": [float(np.float32(x)) for x in mean],
            "deviation": [float(np.float32(x)) for x in deviation]}
