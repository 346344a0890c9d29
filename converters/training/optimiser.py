"""An optimiser with the schedule of its learning rate."""

import torch

from ..errors import ConvertError
from . import schedules

_CLASSES = {"adam": torch.optim.Adam, "rmsprop": torch.optim.RMSprop, "adamw": torch.optim.AdamW}


class Optimiser:
    """`fields`: name, and what PyTorch's class takes (betas, eps, ...); `clip`: largest norm of all
    gradients together."""

    def __init__(self, parameters, fields, schedule, clip=None):
        fields = dict(fields)
        self.schedule, self.clip = schedule, clip
        self.all = _joined([p for p in parameters if p.requires_grad])
        self.inner = _CLASSES[fields.pop("name")]([self.all], lr=1.0, **fields)

    def step(self, loss, step):
        """One step down `loss`, the `step`-th, counted from 1; returns the learning rate."""
        rate = schedules.rate(self.schedule, step)
        for group in self.inner.param_groups:
            group["lr"] = rate
        self.all.grad.zero_()
        loss.backward()
        if self.clip:
            torch.nn.utils.clip_grad_norm_([self.all], self.clip)
        self.inner.step()
        return rate

    def state(self):
        return self.inner.state_dict()

    def load(self, state):
        self.inner.load_state_dict(state)


def _joined(parameters):
    """One tensor whose parts the parameters become, and their gradients parts of its gradient: of
    hundreds of small tensors PyTorch spends more time on each than on what is in it."""
    whole = torch.cat([p.detach().flatten() for p in parameters])
    whole.grad = torch.zeros_like(whole)
    at = 0
    for p in parameters:
        part = slice(at, at + p.numel())
        p.data, p.grad = whole[part].view_as(p), whole.grad[part].view_as(p)
        at = part.stop
    return whole


def check(fields, where):
    name = fields.get("name") if isinstance(fields, dict) else None
    if name not in _CLASSES:
        raise ConvertError(f"{where}: name {name!r}, expected one of {', '.join(_CLASSES)}")
    try:
        Optimiser([torch.nn.Parameter(torch.zeros(1))], fields, {"name": "constant", "rate": 1.0})
    except (TypeError, ValueError) as error:
        raise ConvertError(f"{where}: {str(error).rpartition('() ')[2]}") from None
