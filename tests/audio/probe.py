"""What the tests of models/audio in Python share: the probe and sounds to try it on."""

import os
import pathlib
import subprocess
import tempfile
import unittest
import wave

import numpy as np

SANITIZED = os.environ.get("GESTUS_SANITIZED") == "1"
SOURCE = pathlib.Path(__file__).resolve().parents[2]
LIBRIVOX = pathlib.Path("/usr/share/pocketsphinx/test/data/librivox")


class ProbeTest(unittest.TestCase):
    """A test with a folder of its own and the program audio_probe."""

    PROBE = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def ask(self, *lines, **kwargs):
        """The probe's answers to the lines, each a tuple of fields; the last is its size in KiB."""
        text = "".join("\t".join(map(str, line)) + "\n" for line in lines)
        done = subprocess.run([self.PROBE], input=text.encode(), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, check=False, timeout=600, **kwargs)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout.decode().splitlines()

    def rows(self, command, samples, *arguments, width=1):
        """The rows that a stage makes of float32 samples."""
        np.asarray(samples, "<f4").tofile(self.path("in"))
        answer = self.ask((command, self.path("in"), self.path("out"), *arguments))[0]
        self.assertEqual(answer, "ok")
        rows = np.fromfile(self.path("out"), "<f4")
        return rows.reshape(-1, width) if width > 1 else rows


def speechlike(seconds, rate, seed=1):
    """Syllables of harmonics under moving resonances, noise between them and pauses, 16-bit."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * rate)) / rate
    f0 = 120 + 40 * np.sin(2 * np.pi * 0.7 * t) + 10 * np.sin(2 * np.pi * 3.1 * t)
    phase = 2 * np.pi * np.cumsum(f0) / rate
    voiced = np.zeros_like(t)
    for k in range(1, 60):
        f = k * f0
        gain = sum(a / (1 + ((f - c - d * np.sin(2 * np.pi * 2 * t)) / 90) ** 2)
                   for a, c, d in ((1, 500, 200), (0.5, 1500, 400), (0.2, 2600, 300)))
        voiced += gain * (f < 0.45 * rate) * np.sin(k * phase) / k**0.5
    noise = rng.standard_normal(len(t)) * 0.05
    envelope = np.clip(np.sin(2 * np.pi * 1.9 * t), 0, 1)
    pauses = (t % 2.3) < 1.9
    x = pauses * (envelope * voiced * 0.25 + (1 - envelope) * noise) + 1e-4 * noise
    return (np.round(np.clip(x, -1, 1) * 32767) / 32768).astype(np.float32)


def shared_data():
    """Where recordings that are not part of the repository may be, or None."""
    for folder in (os.environ.get("GESTUS_SHARED"), SOURCE.parent / "shared", "/work/shared"):
        if folder and (pathlib.Path(folder) / "data").is_dir():
            return pathlib.Path(folder) / "data"
    return None


def recordings():
    """(name, samples, rate) of the real speech that this machine has, 16-bit mono WAV."""
    paths = sorted(LIBRIVOX.glob("*.wav"))
    if shared_data() is not None:
        paths += sorted(shared_data().glob("*/*.wav"))
    for path in paths:
        with wave.open(str(path)) as file:
            raw = file.readframes(file.getnframes())
            yield path.name, np.frombuffer(raw, "<i2").astype(np.float32) / 32768, \
                file.getframerate()
