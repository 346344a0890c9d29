"""The losses of the thesis; norms of equations are mean squares over all elements of a batch."""

import torch
from torch.nn import functional as F

PADDING = 0  # the token behind the end of a sequence, which teaches nothing
_EPSILON = 1e-4


def squares(x, y):
    """E ||x - y||^2: eq. 5.3, 6.4 and 6.6."""
    return ((x - y) ** 2).mean()


def tokens(logits, targets):
    """Sum over channels of the mean cross-entropy H(Z, Z'): eq. 5.7 and 5.17.  logits: for each
    channel (B, t, tokens); targets (B, t, channels)."""
    return sum(F.cross_entropy(x.flatten(0, 1), targets[:, :, n].flatten(), ignore_index=PADDING)
               for n, x in enumerate(logits))


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
    """How far the measures of eq. 6.9 are apart: the mean square of the logarithms' difference, over
    speed, acceleration, jerk of the `joints` and the perimeter of the box around all points.

    x, y: (B, T, 2 * points) in units, x of every point and then y.  Regression to the mean shows here
    and not in the mean square of poses.
    """
    pairs = [(_motion(x, joints, order), _motion(y, joints, order)) for order in (1, 2, 3)]
    pairs.append((_perimeter(x), _perimeter(y)))
    return sum(((torch.log(a + 1.0) - torch.log(b + 1.0)) ** 2).mean() for a, b in pairs) / 4


def _motion(x, joints, order):
    """Mean over frames and `joints` of the length of the `order`-th difference: (B,)."""
    points = x.reshape(*x.shape[:2], 2, -1)[..., joints].diff(n=order, dim=1)
    return (points ** 2).sum(2).add(_EPSILON).sqrt().mean((1, 2))


def _perimeter(x):
    points = x.reshape(*x.shape[:2], 2, -1)
    return 2 * (points.amax(3) - points.amin(3)).sum(2).mean(1)
