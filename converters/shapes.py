"""Which tensors a network of a given configuration has.

The keys are those of the PyTorch modules in converters/reference; where checkpoints are published,
their keys.
"""

from . import kinds


def network_shapes(network):
    """key -> shape of a completed network, in the order of the file, after its configuration has
    been checked."""
    kind = kinds.of(network)
    kind.check(network["config"])
    return kind.shapes(network["config"])


def network_tensors(network, tensors):
    """Those of `tensors` that are weights of `network`, and what may accompany them."""
    wanted = {*network_shapes(network), *kinds.of(network).optional}
    return {key: x for key, x in tensors.items() if key in wanted}
