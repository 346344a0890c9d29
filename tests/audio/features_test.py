"""log-mel and filter bank features against librosa's definition and torchaudio.

torchaudio's filter bank is compared with in double precision.  In float32 it lies up to 5e-4 from
itself in double, because preemphasis and weak bins beside strong ones cancel digits; there the mean
difference is what is held.

features_test.py PROBE [unittest arguments]; PROBE is the program audio_probe.
"""

import os
import sys
import unittest

import numpy as np

import librosa_reference
from probe import ProbeTest, recordings, speechlike

try:
    import torch
    import torchaudio.compliance.kaldi as kaldi
except ImportError:
    kaldi = None

TOLERANCE = 1e-4  # on natural logarithms


def kaldi_fbank(samples, dtype):
    """As AST's loader calls it."""
    x = torch.tensor(np.asarray(samples), dtype=dtype)[None]
    return kaldi.fbank(x, htk_compat=True, sample_frequency=16000, use_energy=False,
                       window_type="hanning", num_mel_bins=128, dither=0.0,
                       frame_shift=10).double().numpy()


class FeaturesTest(ProbeTest):

    def compare(self, name, got, want):
        self.assertEqual(got.shape, want.shape, name)
        self.assertTrue(np.isfinite(got).all(), name)
        error = float(np.abs(got - want).max()) if want.size else 0.0
        print(f"{name}: {got.shape[0]} rows, largest difference {error:.1e}")
        self.assertLessEqual(error, TOLERANCE, name)

    def compare_fbank(self, name, got, samples):
        self.compare(f"{name}, fbank", got, kaldi_fbank(np.asarray(samples, float), torch.float64))
        single = np.abs(got - kaldi_fbank(samples, torch.float32))
        print(f"{name}, fbank, torchaudio in float32: mean difference {single.mean():.1e}, "
              f"largest {single.max():.1e}")
        self.assertLessEqual(single.mean(), 1e-5, name)

    def compare_log_mel(self, name, y, rate):
        self.compare(f"{name}, log_mel_512 at {rate} Hz",
                     self.rows("log_mel_512", y, rate, width=128),
                     librosa_reference.log_mel_512(y, rate))

    def test_log_mel_512_of_speechlike_sound(self):
        for rate in (8000, 11025, 16000, 22050, 44100, 48000, 96000):
            self.compare_log_mel("speechlike", speechlike(4.3, rate, rate), rate)

    def test_log_mel_512_of_short_sounds(self):
        y = speechlike(1, 16000)[3000:6000]
        for n in (511, 512, 1000, 1023, 1024, 1025, 1026, 1535, 1536, 2047, 2048, 2049,
                  2600):
            self.compare_log_mel(f"{n} samples", y[:n], 16000)
        self.assertEqual(self.rows("log_mel_512", [], 16000, width=128).shape, (0, 128))

    def test_log_mel_512_of_very_short_sounds(self):
        """Mirrored over and over they are a few lines; between these lies rounding alone."""
        y = speechlike(1, 16000)[3000:]
        for n in (1, 2, 3, 10, 100):
            got = np.exp(self.rows("log_mel_512", y[:n], 16000, width=128))
            want = np.exp(librosa_reference.log_mel_512(y[:n], 16000))
            self.assertEqual(got.shape, want.shape)
            self.assertLessEqual(np.abs(got - want).max(), 1e-6 * want.max(), n)

    def test_log_mel_512_of_silence(self):
        rows = self.rows("log_mel_512", np.zeros(44100), 44100, width=128)
        self.assertEqual(rows.shape, (87, 128))
        self.assertTrue((rows == np.float32(np.log(1e-10))).all())

    def test_log_mel_400(self):
        y = speechlike(4.3, 16000)
        self.compare("speechlike, log_mel_400", self.rows("log_mel_400", y, width=64),
                     librosa_reference.log_mel_400(y))
        for n, rows in ((511, 0), (512, 1), (671, 1), (672, 2)):
            self.assertEqual(len(self.rows("log_mel_400", y[:n], width=64)), rows)
        silence = self.rows("log_mel_400", np.zeros(1000), width=64)
        self.assertTrue((silence == np.float32(np.log(1e-6))).all())

    @unittest.skipIf(kaldi is None, "no torchaudio")
    def test_fbank_of_speechlike_sound(self):
        for seed in range(3):
            y = speechlike(4.3, 16000, seed)
            self.compare_fbank("speechlike", self.rows("fbank", y, 0, width=128), y)

    @unittest.skipIf(kaldi is None, "no torchaudio")
    def test_fbank_without_the_mean(self):
        y = speechlike(4.3, 16000) + np.float32(0.05)
        mean = y.mean()
        want = kaldi_fbank((y - mean).astype(float), torch.float64)
        self.compare("fbank, mean taken off", self.rows("fbank", y, mean, width=128), want)
        self.compare("fbank, mean left in", self.rows("fbank", y, 0, width=128), want)

    @unittest.skipIf(kaldi is None, "no torchaudio")
    def test_fbank_of_short_sounds_and_silence(self):
        y = speechlike(1, 16000)[3000:]
        for n in (400, 401, 559, 560, 561, 719, 720):
            self.compare(f"fbank of {n} samples", self.rows("fbank", y[:n], 0, width=128),
                         kaldi_fbank(y[:n], torch.float64))
        for n in (0, 1, 399):
            self.assertEqual(len(self.rows("fbank", y[:n], 0, width=128)), 0)
        silence = self.rows("fbank", np.zeros(1000), 0, width=128)
        self.assertTrue((silence == np.float32(np.log(2.0**-23))).all())

    def test_real_speech(self):
        found = list(recordings())
        if not found:
            self.skipTest("no recordings: neither pocketsphinx-testdata nor shared data is here")
        for name, y, rate in found:
            self.compare_log_mel(name, y, rate)
            if rate != 16000:
                continue
            self.compare(f"{name}, log_mel_400", self.rows("log_mel_400", y, width=64),
                         librosa_reference.log_mel_400(y))
            if kaldi is not None:
                self.compare_fbank(name, self.rows("fbank", y, y.mean(), width=128), y - y.mean())


if __name__ == "__main__":
    ProbeTest.PROBE = os.path.abspath(sys.argv.pop(1))
    unittest.main()
