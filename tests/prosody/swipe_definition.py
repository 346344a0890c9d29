"""SWIPE' transcribed from its definition with numpy, the oracle of swipe_test.py.

Written from the published method (Camacho and Harris 2008) and the description of the programs in
use, frame by frame and without any of the shortcuts of models/prosody/.
"""
import numpy as np

OCTAVES, ERBS, FINE = 0.0104167, 0.1, 0.0013028


def hz_to_erb(hz):
    return 21.4 * np.log10(1 + hz / 229)


def erb_to_hz(erb):
    return (10 ** (erb / 21.4) - 1) * 229


def half_up(x):
    return int(np.floor(x + 0.5))


def sptk_spline(y, h, at):
    """y (knots, frames) at 0, h, 2h, ... read `at` places: ends of slope 2, and a product where a sum should be."""
    n = len(y)
    u, ratio = np.zeros_like(y), np.zeros(n)
    ratio[0] = -0.5
    u[0] = 3 / h * ((y[1] - y[0]) / h - 2.0)
    for i in range(1, n - 1):
        p = 0.5 * ratio[i - 1] + 2
        ratio[i] = -0.5 / p
        bend = ((y[i + 1] - y[i]) / h - (y[i] - y[i - 1]) / h) / (2 * h)
        u[i] = (6 * bend - 0.5 * u[i - 1]) / p
    y2 = np.zeros_like(y)
    y2[-1] = (3 / h * (2.0 - (y[-1] - y[-2]) / h) - 0.5 * u[n - 2]) / (0.5 * ratio[n - 2] + 1)
    for i in range(n - 2, -1, -1):
        y2[i] = ratio[i] * y2[i + 1] + u[i]
    lo = np.minimum((at / h).astype(int), n - 2)
    b = (at / h - lo)[:, None]
    a = 1 - b
    return (a * y[lo] + b * y[lo + 1]
            + (a ** 3 - a) * y2[lo] * (b ** 3 - b) * y2[lo + 1] * h * h / 6)


def natural_spline(y, h, at):
    """The same, ends without curvature."""
    n = len(y)
    right = 6 * (y[2:] - 2 * y[1:-1] + y[:-2]) / h ** 2
    diagonal = np.full(n - 2, 4.0)
    for i in range(1, n - 2):
        factor = 1 / diagonal[i - 1]
        diagonal[i] -= factor
        right[i] = right[i] - factor * right[i - 1]
    y2 = np.zeros_like(y)
    for i in range(n - 3, -1, -1):
        y2[i + 1] = (right[i] - y2[i + 2]) / diagonal[i]
    lo = np.minimum((at / h).astype(int), n - 2)
    b = (at / h - lo)[:, None]
    a = 1 - b
    return (a * y[lo] + b * y[lo + 1]
            + ((a ** 3 - a) * y2[lo] + (b ** 3 - b) * y2[lo + 1]) * h * h / 6)


def loudness(x, rate, size, bands, mode):
    """(frames, bands), each frame of norm 1."""
    half = size // 2
    frames = -(-len(x) // half) + 1
    padded = np.concatenate([np.zeros(half), x, np.zeros(2 * size)])
    hann = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(size) / size)
    cut = np.stack([padded[i * half:i * half + size] * hann for i in range(frames)])
    magnitudes = np.abs(np.fft.rfft(cut)).T
    if mode == "sptk":
        values = sptk_spline(magnitudes[:half], rate / size, bands)
    else:
        values = natural_spline(magnitudes, rate / size, bands)
    rows = np.sqrt(np.maximum(values, 0)).T
    norms = np.sqrt((rows ** 2).sum(1, keepdims=True))
    return rows / np.where(norms > 0, norms, 1)


def kernel(candidate, bands, harmonics):
    q = bands / candidate
    k = np.zeros(len(bands))
    for n in harmonics:
        distance = np.abs(q - n)
        near, far = distance < 0.25, (distance >= 0.25) & (distance < 0.75)
        k[near] = np.cos(2 * np.pi * q[near])
        k[far] += np.cos(2 * np.pi * q[far]) / 2
    k *= np.sqrt(1 / bands)
    return k / np.sqrt((k[k > 0] ** 2).sum())


def strengths(x, rate, hop, low, high, mode):
    """(candidates, rows) and the candidates in Hz; `hop` in samples."""
    count = int(np.ceil((np.log2(high) - np.log2(low)) / OCTAVES))
    candidates = 2 ** (np.log2(low) + OCTAVES * np.arange(count))
    first_erb = hz_to_erb(low / 4)
    bands = erb_to_hz(
        first_erb + ERBS * np.arange(int(np.ceil((hz_to_erb(rate / 2) - first_erb) / ERBS))))
    most = int(np.floor(bands[-1] / candidates[0] - 0.75))
    harmonics = [1] + [n for n in range(2, most + 1)
                       if all(n % m for m in range(2, int(n ** 0.5) + 1))]
    windows = half_up(np.log2(8 * rate / low) - np.log2(8 * rate / high)) + 1
    largest = 2 ** half_up(np.log2(8 * rate / low))
    d = 1 + np.log2(candidates) - np.log2(8 * rate / largest)
    rows = int(np.ceil(len(x) / hop))
    out = np.zeros((count, rows))
    for k in range(windows):
        size = largest >> k
        served = np.flatnonzero(((k == 0) | (d > k)) & ((k == windows - 1) | (d < k + 2)))
        weight = 1 - np.abs(d[served] - (k + 1))
        if mode != "sptk":
            weight[(k == 0) & (d[served] < 1)] = 1
            weight[(k == windows - 1) & (d[served] > windows)] = 1
        frames = loudness(x, rate, size, bands, mode)
        local = np.stack([kernel(candidates[c], bands, harmonics) for c in served]) @ frames.T
        time = np.arange(rows) * hop / (size // 2)
        before = np.floor(time).astype(int)
        after = time - before
        out[served] += weight[:, None] * (
            local[:, before] * (1 - after) + local[:, before + 1] * after)
    return out, candidates


def swipe(x, rate, hop, low=50.0, high=550.0, mode="textbook", threshold=0.3):
    """f0 in Hz (0 unvoiced) and the highest strength of each row."""
    x = np.asarray(x, np.float64)
    s, candidates = strengths(x, rate, hop, low, high, mode)
    f0 = np.zeros(s.shape[1])
    if not s.shape[1]:
        return f0, f0
    abscissae = (candidates[1] / candidates[:3] - 1) * 2 * np.pi
    steps = half_up((np.log2(candidates[2]) - np.log2(candidates[0])) / FINE + 1)
    last = len(candidates) - 1
    for j, best in enumerate(s.argmax(0)):
        if s[best, j] <= threshold:
            continue
        if best in (0, last):
            f0[j] = candidates[0 if mode == "sptk" else best]
            continue
        parabola = np.linalg.solve(np.vander(abscissae, 3), s[best - 1:best + 2, j])
        octaves = np.log2(candidates[best - 1]) + FINE * np.arange(steps)
        heights = np.polyval(parabola, (candidates[best] / 2 ** octaves - 1) * 2 * np.pi)
        f0[j] = 2 ** octaves[heights.argmax()]
    return f0, s.max(0)
