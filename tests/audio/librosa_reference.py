"""librosa's mel spectrogram as PATS called it (release 0.6 to 0.9), from its documented definition.

Everything is computed in double precision; numpy.pad and numpy.fft do what librosa had them do.
"""

import numpy as np


def slaney_mel(hz):
    """Slaney's Auditory Toolbox: linear below 1 kHz, logarithmic above."""
    hz = np.asarray(hz, float)
    with np.errstate(divide="ignore"):
        high = 15 + 27 * np.log(hz / 1000) / np.log(6.4)
    return np.where(hz < 1000, hz * 3 / 200, high)


def slaney_hz(mel):
    mel = np.asarray(mel, float)
    return np.where(mel < 15, mel * 200 / 3, 1000 * 6.4 ** ((mel - 15) / 27))


def mel_filters(rate, n_fft, n_mels, f_min, f_max, norm):
    corners = slaney_hz(np.linspace(slaney_mel(f_min), slaney_mel(f_max), n_mels + 2))
    bins = np.linspace(0, rate / 2, 1 + n_fft // 2)
    filters = np.zeros((n_mels, len(bins)))
    for k in range(n_mels):
        low, middle, high = corners[k : k + 3]
        filters[k] = np.clip(np.minimum((bins - low) / (middle - low),
                                        (high - bins) / (high - middle)), 0, None)
        if norm:
            filters[k] *= 2 / (high - low)
    return filters


def magnitudes(y, n_fft, hop, window, center):
    hann = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(window) / window)
    before = (n_fft - window) // 2
    hann = np.pad(hann, (before, n_fft - window - before))
    y = np.asarray(y, float)
    if center:
        y = np.pad(y, n_fft // 2, mode="reflect")
    frames = np.lib.stride_tricks.sliding_window_view(y, n_fft)[::hop]
    return np.abs(np.fft.rfft(hann * frames, axis=1))


def log_with_floor(mel, floor):
    mel = mel.astype(np.float32).astype(float)
    return np.log(np.where(mel == 0, floor, mel))


def log_mel_512(y, rate):
    mel = magnitudes(y, 2048, 512, 2048, True) ** 2 @ mel_filters(rate, 2048, 128, 0, rate / 2,
                                                                  True).T
    return log_with_floor(mel, 1e-10)


def log_mel_400(y):
    mel = magnitudes(y, 512, 160, 400, False) @ mel_filters(16000, 512, 64, 125, 7500, False).T
    return log_with_floor(mel, 1e-6)
