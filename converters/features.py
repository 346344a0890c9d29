"""Features of recordings and words, as PATS has them (Ahuja et al. 2020) and the thesis uses them.

Functions of arrays: reading audio files and transcripts is the caller's business.
"""

import hashlib

import numpy as np

FRAME_RATE = 15.0  # frames per second of text and pose
N_FFT = 2048
HOP = 512
MEL_BINS = 128
# What PATS' loader takes log_mel_512 to have: int(45.6 * 1000 / 512) rows per second.
PATS_MEL_RATE = 89
D_TEXT = 768


def log_mel_512(samples, rate):
    """Log-mel spectrogram (rows, 128) of mono `samples` in [-1, 1], at the recording's own rate.

    librosa's definition: 2048-point STFT, periodic Hann window, hop 512, centred with reflected
    ends, power; 128 mel bands, Slaney's scale and area normalisation, 0 to rate / 2; natural
    logarithm, exact zeros taken as 1e-10.
    """
    samples = np.asarray(samples, np.float64)
    if samples.ndim != 1 or samples.size <= N_FFT // 2:
        raise ValueError(f"samples: shape {samples.shape}, expected one channel of more than "
                         f"{N_FFT // 2}")
    padded = np.pad(samples, N_FFT // 2, mode="reflect")
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(N_FFT) / N_FFT)
    frames = np.lib.stride_tricks.sliding_window_view(padded, N_FFT)[::HOP]
    filters = mel_filters(rate)
    mel = np.empty((len(frames), MEL_BINS))
    for begin in range(0, len(frames), 256):  # spectra of a long recording need not stand at once
        spectra = np.fft.rfft(frames[begin:begin + 256] * window, axis=1)
        mel[begin:begin + 256] = (spectra.real ** 2 + spectra.imag ** 2) @ filters.T
    mel[mel == 0] = 1e-10
    return np.log(mel).astype(np.float32)


def mel_filters(rate, n_fft=N_FFT, bins=MEL_BINS):
    """Triangles of unit area in hertz (Slaney), equally wide in mel: (bins, n_fft / 2 + 1)."""
    edges = _mel_to_hz(np.linspace(0, _hz_to_mel(rate / 2), bins + 2))
    frequencies = np.arange(n_fft // 2 + 1) * (rate / n_fft)
    rising = (frequencies - edges[:-2, None]) / np.diff(edges)[:-1, None]
    falling = (edges[2:, None] - frequencies) / np.diff(edges)[1:, None]
    height = 2 / (edges[2:] - edges[:-2])
    return np.clip(np.minimum(rising, falling), 0, None) * height[:, None]


# Slaney's scale: linear below 1 kHz (15 mel), logarithmic above, 27 steps for a factor of 6.4.
_LINEAR = 200.0 / 3
_LOG_STEP = np.log(6.4) / 27


def _hz_to_mel(hz):
    return hz / _LINEAR if hz < 1000 else 15 + np.log(hz / 1000) / _LOG_STEP


def _mel_to_hz(mel):
    return np.where(mel < 15, mel * _LINEAR, 1000 * np.exp(_LOG_STEP * (mel - 15)))


def to_frames(rows, rate, frames=None):
    """Every k-th of `rows`, k = round(rate / 15), as PATS' loader thins features to 15 a second.

    `rate` is what the loader takes for the rows of a second, PATS_MEL_RATE for log_mel_512 of 44.1
    or 48 kHz; other recordings have their sample rate / 512.  `frames` cuts the result, or fills it
    up by repeating the last row.
    """
    stride = max(1, round(rate / FRAME_RATE))
    thinned = rows[::stride]
    return thinned if frames is None else fit(thinned, frames)


def speech_frames(samples, rate):
    """X_speech (T, 128) of a recording: log_mel_512 at 15 frames per second.

    T = int(seconds * 15).  Rows are picked by time instead of by a whole stride, which differs from
    PATS only where the stride would drift: at 48 kHz by 4 % of the recording's length.
    """
    mel = log_mel_512(samples, rate)
    frames = max(1, int(len(samples) / rate * FRAME_RATE))
    at = np.round(np.arange(frames) / FRAME_RATE * rate / HOP).astype(int)
    return mel[np.minimum(at, len(mel) - 1)]


def fit(rows, frames):
    """`rows` cut to `frames`, or filled up by repeating the last one."""
    if len(rows) == 0:
        raise ValueError("no rows to repeat")
    return rows[np.minimum(np.arange(frames), len(rows) - 1)]


def words_to_frames(starts, frames, rate=FRAME_RATE):
    """Index of the word at each of `frames` frames, from the words' start times in seconds.

    PATS' rule: the first word begins at frame 0, any other at int(start * rate), each lasts until
    the next begins and the last to the end, so there are no gaps.
    """
    if len(starts) == 0:
        raise ValueError("no words")
    index = np.zeros(frames, np.int64)
    for i, start in enumerate(starts):
        if i > 0:
            index[min(max(int(start * rate), 0), frames):] = i
    return index


def hash_embedding(word):
    """STAND-IN for BERT, which gestus does not run yet: a fixed pseudo-random vector (768) of zero
    mean and unit variance for each word.  It tells words apart and knows nothing of meaning."""
    seed = int.from_bytes(hashlib.sha256(word.lower().encode()).digest()[:8], "little")
    x = np.random.default_rng(seed).standard_normal(D_TEXT)
    return ((x - x.mean()) / x.std()).astype(np.float32)


def text_frames(words, starts, frames):
    """X_text (frames, 768) of `words` that begin at `starts` seconds, by `hash_embedding`."""
    if len(words) != len(starts):
        raise ValueError(f"{len(words)} words and {len(starts)} start times, expected as many")
    table = np.stack([hash_embedding(word) for word in words])
    return table[words_to_frames(starts, frames)]
