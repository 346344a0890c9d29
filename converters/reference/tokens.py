"""From tokens (steps, channels) to what they stand for."""

import torch

from ..channels import SPECIAL


def most_probable(scores):
    """Index of the largest along the last axis, the lowest of equals."""
    return torch.from_numpy(scores.numpy().argmax(-1))  # torch.argmax leaves open which


def face_of(tokens, channels):
    """Values (..., channels); padding, start and end stand for zero."""
    minimum, step = (torch.tensor([channel[key] for channel in channels], dtype=torch.float64)
                     for key in ("minimum", "step"))
    return torch.where(tokens >= SPECIAL, minimum + step * (tokens - SPECIAL), 0.0)


def lengths_of(tokens):
    """(steps, channels) -> steps of each channel before its first padding or end."""
    over = ((tokens == 0) | (tokens == 2)).numpy()
    return torch.tensor([int(ends.argmax()) if ends.any() else len(ends) for ends in over.T])
