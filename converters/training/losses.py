"""The losses of the thesis; norms of equations are mean squares over all elements of a batch."""

import torch
from torch.nn import functional as F

from ..channels import SPECIAL

PADDING = 0  # the token behind the end of a sequence, which teaches nothing
_EPSILON = 1e-4


def squares(x, y):
    """E ||x - y||^2: eq. 5.3, 6.4 and 6.6."""
    return ((x - y) ** 2).mean()


def tokens(logits, targets, spread=0.0):
    """Sum over channels of the mean cross-entropy H(Z, Z'): eq. 5.7 and 5.17.  logits: for each
    channel (B, t, tokens); targets (B, t, channels).  With a `spread`, in levels, the target of a
    level is a bell over its neighbours, so that they learn from one another."""
    return sum(_cross_entropy(x.flatten(0, 1), targets[:, :, n].flatten(), spread)
               for n, x in enumerate(logits))


def _cross_entropy(logits, targets, spread):
    if not spread:
        return F.cross_entropy(logits, targets, ignore_index=PADDING)
    wanted = _bells(logits.shape[1], spread).to(logits)[targets]
    entropies = -(wanted * logits.log_softmax(1)).sum(1)
    return entropies[targets != PADDING].mean()


def _bells(count, spread):
    """(tokens, tokens): the distribution that is wanted for each token."""
    distance = torch.arange(count) - torch.arange(count)[:, None]
    bells = torch.exp(-0.5 * (distance / spread) ** 2)
    bells[:SPECIAL], bells[:, :SPECIAL] = 0.0, 0.0
    bells[range(SPECIAL), range(SPECIAL)] = 1.0
    return bells / bells.sum(1, keepdim=True)


def fader(style, predicted, span):
    """Eq. 6.7, E ||1 - error||^2: low when Dis cannot tell the style.  The error of each component
    is brought into 0 to 1 by `span`, the component's range; all (B, d_style) but span (d_style,)."""
    error = ((style - predicted).abs() / span).clamp(max=1.0)
    return ((1.0 - error) ** 2).mean()


def span_of(style):
    """The range of each component over a batch (B, d_style): what `fader` divides errors by."""
    return (style.max(0).values - style.min(0).values).clamp_min(_EPSILON)


def velocity(x, y):
    """Mean square of differences between frames: (B, T, columns)."""
    return squares(x.diff(dim=1), y.diff(dim=1))


def behaviour(x, y, joints):
    """How far the `measures` of two motions are apart: the mean square of the logarithms' difference.
    Regression to the mean shows here and not in the mean square of poses."""
    return (((measures(x, joints) + 1).log() - (measures(y, joints) + 1).log()) ** 2).mean()


def amount(x, y, joints, usual):
    """The same in shares of `usual` measures (4, 1).  It is least where a motion has as much of each
    as the other on the average; that of logarithms at the geometric mean, which of somebody who
    moves now and then is less.  Quick windows weigh most in it: it is for networks that can move."""
    return (((measures(x, joints) - measures(y, joints)) / usual) ** 2).mean()


def measures(x, joints):
    """What eq. 6.9 compares, of each of a batch: speed, acceleration and jerk of the `joints`, by the
    frame, and the perimeter of the box around all points; (4, B).

    x: (B, T, 2 * points) in units, x of every point and then y."""
    return torch.stack([*(_motion(x, joints, order) for order in (1, 2, 3)), _perimeter(x)])


def _motion(x, joints, order):
    """Mean over frames and `joints` of the length of the `order`-th difference: (B,)."""
    points = x.reshape(*x.shape[:2], 2, -1)[..., joints].diff(n=order, dim=1)
    return (points ** 2).sum(2).add(_EPSILON).sqrt().mean((1, 2))


def _perimeter(x):
    points = x.reshape(*x.shape[:2], 2, -1)
    return 2 * (points.amax(3) - points.amin(3)).sum(2).mean(1)
