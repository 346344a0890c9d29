"""Learning rates by step, the first step being 1, and the weight of the fader loss."""

import math

from ..errors import ConvertError


def rate(schedule, step):
    """The learning rate of `step` by a schedule of a configuration."""
    fields = dict(schedule)
    name = fields.pop("name")
    return SCHEDULES[name](step, **fields)


def constant(_step, rate):
    return rate


def warmup(step, rate, steps):
    """Rises to `rate` in `steps` steps and stays there."""
    return rate * min(1.0, step / steps)


def noam(step, d_model, warmup, factor=1.0):
    """Vaswani et al. 2017, section 5.3; thesis 5.6.2."""
    return factor * d_model ** -0.5 * min(step ** -0.5, step * warmup ** -1.5)


def cyclical(step, low, high, half):
    """Triangles (Smith 2017) between `low` and `high`, `half` steps up and as many down; thesis 7.4."""
    cycle = (step - 1) / (2 * half)
    return low + (high - low) * (1 - abs(2 * (cycle % 1.0) - 1))


def cosine(step, rate, warmup, steps, least=0.02):
    """Rises in `warmup` steps to `rate` and falls to `least` of it at `steps`."""
    if step <= warmup:
        return rate * step / warmup
    at = min(1.0, (step - warmup) / max(1, steps - warmup))
    return rate * (least + (1 - least) * 0.5 * (1 + math.cos(math.pi * at)))


def fader_weight(step, step_size=0.01, maximum=1.0):
    """Lambda of eq. 6.8: 0 at the first step, `step_size` more after each.  The thesis names no
    end of it; without one the fader loss soon outweighs everything."""
    return min(maximum, step_size * (step - 1))


SCHEDULES = {function.__name__: function for function in (constant, warmup, noam, cyclical, cosine)}


def check(schedule, where):
    """One sentence about a schedule that cannot be."""
    name = schedule.get("name") if isinstance(schedule, dict) else None
    if name not in SCHEDULES:
        raise ConvertError(f"{where}: name {name!r}, expected one of {', '.join(SCHEDULES)}")
    try:
        value = rate(schedule, 1)
    except TypeError as error:
        raise ConvertError(f"{where}: {str(error).split('() ')[-1]}") from None
    if not value > 0:
        raise ConvertError(f"{where}: a rate of {value} at the first step, expected more than 0")
