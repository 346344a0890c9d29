"""Features against definitions written out anew, and torch's STFT."""

import numpy as np
import pytest

from converters import features


def slaney_hz(mel):
    return 200 / 3 * mel if mel < 15 else 1000 * 6.4 ** ((mel - 15) / 27)


@pytest.mark.parametrize("rate", [16000, 44100, 48000])
def test_mel_filters(rate):
    got = features.mel_filters(rate)
    top = 15 + 27 * np.log(rate / 2 / 1000) / np.log(6.4)
    edges = [slaney_hz(top * i / 129) for i in range(130)]
    for band in (0, 1, 40, 80, 127):
        low, centre, high = edges[band:band + 3]
        for k in range(0, 1025, 5):
            f = k * rate / 2048
            weight = max(0.0, min((f - low) / (centre - low), (high - f) / (high - centre)))
            assert got[band, k] == pytest.approx(weight * 2 / (high - low), abs=1e-9)


def test_log_mel_against_torch():
    torch = pytest.importorskip("torch")
    rate = 22050
    x = np.random.default_rng(7).standard_normal(30000) * 0.1
    spectrum = torch.stft(torch.from_numpy(x), 2048, 512, window=torch.hann_window(
        2048, periodic=True, dtype=torch.float64), center=True, pad_mode="reflect",
        return_complex=True)
    want = np.log(features.mel_filters(rate) @ (spectrum.abs() ** 2).numpy()).T
    got = features.log_mel_512(x, rate)
    assert got.shape == (1 + 30000 // 512, 128)
    np.testing.assert_allclose(got, want, atol=1e-5)


def test_silence_and_short_recordings():
    assert np.all(features.log_mel_512(np.zeros(4000), 16000) == np.float32(np.log(1e-10)))
    with pytest.raises(ValueError, match="expected one channel"):
        features.log_mel_512(np.zeros(1024), 16000)


def test_pats_segment_has_64_rows():
    rows = np.arange(int(4.3 * features.PATS_MEL_RATE))
    assert len(features.to_frames(rows, features.PATS_MEL_RATE)) == 64
    assert features.to_frames(rows, features.PATS_MEL_RATE)[1] == 6
    assert features.to_frames(rows, features.PATS_MEL_RATE, 66)[-1] == 63 * 6


@pytest.mark.parametrize("rate", [16000, 44100, 48000])
def test_speech_frames_keep_time(rate):
    """A click at 2 s is loudest in the frame at 2 s, whatever the rate."""
    x = np.random.default_rng(8).standard_normal(rate * 4) * 1e-4
    x[2 * rate:2 * rate + rate // 50] = 1
    speech = features.speech_frames(x, rate)
    assert speech.shape == (60, 128)
    assert abs(int(speech.mean(1).argmax()) - 30) <= 1


def test_words_to_frames():
    """The first word begins at once, there are no gaps, the last one lasts."""
    got = features.words_to_frames([0.4, 0.5, 0.99, 9.0], 20)
    assert got.tolist() == [0] * 7 + [1] * 7 + [2] * 6
    with pytest.raises(ValueError):
        features.words_to_frames([], 3)


def test_hash_embedding():
    a = features.hash_embedding("gesture")
    assert a.shape == (768,) and abs(a.mean()) < 1e-6 and abs(a.std() - 1) < 1e-5
    np.testing.assert_array_equal(a, features.hash_embedding("Gesture"))
    assert abs(np.corrcoef(a, features.hash_embedding("gestures"))[0, 1]) < 0.2
    text = features.text_frames(["so", "what"], [0, 0.2], 5)
    np.testing.assert_array_equal(text[3:], [features.hash_embedding("what")] * 2)
