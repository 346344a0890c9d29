"""Sound files that other programs wrote, and very long ones.

wav_files_test.py PROBE [unittest arguments]; PROBE is the program audio_probe.
"""

import os
import resource
import struct
import sys
import unittest
import wave

import numpy as np

from probe import ProbeTest, SANITIZED, recordings, shared_data, LIBRIVOX

try:
    from scipy.io import wavfile
except ImportError:
    wavfile = None


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (512 << 20, 512 << 20))


class WavFilesTest(ProbeTest):

    def read(self, path):
        """(mono samples, rate, channels, notes) of a file."""
        answer = self.ask(("read", path, self.path("out")))[0].split("\t")
        self.assertEqual(answer[0], "ok", answer)
        mono = np.fromfile(self.path("out"), "<f4")
        rate, channels, frames = map(int, answer[1:4])
        self.assertEqual(frames, len(mono))
        return mono, rate, channels, answer[4:]

    def test_files_of_the_wave_module(self):
        rng = np.random.default_rng(1)
        for width in (1, 2, 3, 4):
            for channels in (1, 2, 5):
                raw = rng.integers(0, 256, 1001 * channels * width, np.uint8).tobytes()
                with wave.open(self.path("a.wav"), "wb") as file:
                    file.setparams((channels, width, 22050, 0, "NONE", None))
                    file.writeframes(raw)
                values = np.zeros((1001, channels))
                for i in range(width):
                    values += np.frombuffer(raw, np.uint8)[i::width].reshape(values.shape) * 256.0**i
                half = 256.0**width / 2
                values = values - half if width == 1 else values - 2 * half * (values >= half)
                want = (values / half).astype(np.float32).astype(float).mean(axis=1)
                mono, rate, got_channels, notes = self.read(self.path("a.wav"))
                self.assertEqual((rate, got_channels, notes), (22050, channels, []))
                np.testing.assert_array_equal(mono, want.astype(np.float32))

    @unittest.skipIf(wavfile is None, "no scipy")
    def test_files_of_scipy(self):
        rng = np.random.default_rng(2)
        for dtype, scale in ((np.uint8, 2**7), (np.int16, 2**15), (np.int32, 2**31),
                             (np.float32, 1), (np.float64, 1)):
            for channels in (1, 6):
                if scale == 1:
                    data = rng.uniform(-1, 1, (999, channels)).astype(dtype)
                else:
                    info = np.iinfo(dtype)
                    data = rng.integers(info.min, info.max, (999, channels), endpoint=True)
                    data = data.astype(dtype)
                wavfile.write(self.path("a.wav"), 96000, data)
                offset = 128 if dtype == np.uint8 else 0
                want = ((data.astype(float) - offset) / scale).astype(np.float32)
                mono, rate, got_channels, notes = self.read(self.path("a.wav"))
                self.assertEqual((rate, got_channels, notes), (96000, channels, []))
                np.testing.assert_allclose(mono, want.astype(float).mean(axis=1), rtol=0, atol=6e-8)

    def test_recordings(self):
        found = list(recordings())
        if not found:
            self.skipTest("no recordings: neither pocketsphinx-testdata nor shared data is here")
        for name, samples, rate in found:
            folders = [LIBRIVOX] + (list(shared_data().iterdir()) if shared_data() else [])
            path = next(folder / name for folder in folders if (folder / name).exists())
            mono, got_rate, channels, notes = self.read(path)
            self.assertEqual((got_rate, channels, notes), (rate, 1, []), name)
            np.testing.assert_array_equal(mono, samples)

    def long_file(self, form, fmt, data_bytes, said):
        """A file of which only the beginning is on the disk: the rest is a hole of zeros."""
        path = self.path("long.wav")
        with open(path, "wb") as file:
            sizes = struct.pack("<QQQI", data_bytes + 72, data_bytes, 0, 0)
            ds64 = b"ds64" + struct.pack("<I", len(sizes)) + sizes if form == b"RF64" else b""
            file.write(form + struct.pack("<I", 0xFFFFFFFF) + b"WAVE" + ds64)
            file.write(b"fmt " + struct.pack("<I", len(fmt)) + fmt)
            file.write(b"data" + struct.pack("<I", said))
            file.truncate(file.tell() + data_bytes)
        return path

    @unittest.skipIf(SANITIZED, "the address sanitizer reserves terabytes of addresses")
    def test_ten_hours_in_little_memory(self):
        hours10 = 36000 * 8000
        fmt = struct.pack("<HHIIHH", 1, 1, 8000, 8000, 1, 8)
        path = self.long_file(b"RIFF", fmt, hours10, 0xFFFFFFFF)
        answer, kilobytes = self.ask(("read", path, "-"), preexec_fn=limit_memory)
        self.assertEqual(answer, f"ok\t8000\t1\t{hours10}\tdata: says 4,294,967,295 bytes, but "
                                 f"{hours10:,} follow; read to the end of the file")
        self.assertLess(int(kilobytes), 32 << 10)

    @unittest.skipIf(SANITIZED, "the address sanitizer reserves terabytes of addresses")
    def test_more_than_four_gibibytes(self):
        """64 channels of float64 make few frames of many bytes."""
        block, frames = 64 * 8, (9 << 30) // 2 // 512
        fmt = struct.pack("<HHIIHH", 3, 64, 48000, 48000 * block, block, 64)
        path = self.long_file(b"RF64", fmt, block * frames, 0xFFFFFFFF)
        answer, _ = self.ask(("head", path, "-"))
        self.assertEqual(answer, f"ok\t48000\t64\t{frames}")
        # A writer that kept only the lower half of the size.
        path = self.long_file(b"RIFF", fmt, block * frames, (block * frames) % 2**32)
        answer, _ = self.ask(("head", path, "-"))
        self.assertEqual(answer, f"ok\t48000\t64\t{frames}\tdata: says 536,870,912 bytes, but "
                                 f"{block * frames:,} follow; read to the end of the file")


if __name__ == "__main__":
    ProbeTest.PROBE = os.path.abspath(sys.argv.pop(1))
    unittest.main()
