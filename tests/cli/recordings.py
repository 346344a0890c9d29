"""Recordings, transcripts and poses for the tests of infer-cli's front end."""

import json
import os
import struct
import tempfile

import numpy as np

from cli_harness import CliTest
import tiny_weights

WORDS = [("Hello", 0.1, 0.4), ("there,", 0.4, 0.7), ("how", 0.85, 1.1), ("are", 1.1, 1.3),
         ("you?", 1.3, 1.7), ("Deep", 2.2, 2.5), ("learning", 2.5, 3.1), ("is", 3.1, 3.2),
         ("fun.", 3.2, 3.6)]


def voice(seconds, rate):
    t = np.arange(int(seconds * rate)) / rate
    loud = np.maximum(0, np.sin(2 * np.pi * 0.7 * t))
    noise = np.random.default_rng(1).standard_normal(len(t))
    buzz = sum(np.sin(2 * np.pi * 120 * k * t) / k for k in range(1, 12))
    return 0.2 * loud * buzz + 0.005 * noise


def wav(samples, rate, channels=1, data_bytes=None):
    """A file of 16 bits, whose header may lie about its size."""
    data = np.repeat(np.asarray(32767 * samples, "<i2"), channels).tobytes()
    size = len(data) if data_bytes is None else data_bytes
    form = struct.pack("<HHIIHH", 1, channels, rate, 2 * channels * rate, 2 * channels, 16)
    return (b"RIFF" + struct.pack("<I", (36 + size) & 0xffffffff) + b"WAVEfmt "
            + struct.pack("<I", 16) + form + b"data" + struct.pack("<I", size) + data)


def float_wav(samples, rate):
    data = np.asarray(samples, "<f4").tobytes()
    return (b"RIFF" + struct.pack("<I", 36 + len(data)) + b"WAVEfmt " + struct.pack("<I", 16)
            + struct.pack("<HHIIHH", 3, 1, rate, 4 * rate, 4, 32)
            + b"data" + struct.pack("<I", len(data)) + data)


def lines(words):
    return "".join(f"{start} {end} {word}\n" for word, start, end in words).encode()


def pose_frame(i, people=1):
    body = [v for k in range(25) for v in (300 + 4 * k + 9 * np.sin(i / 5), 200 + 8 * k, 0.9)]
    face = [v for k in range(70) for v in (290 + k, 150 - k / 2 + np.cos(i / 3), 0.8)]
    person = {"pose_keypoints_2d": body, "face_keypoints_2d": face,
              "hand_left_keypoints_2d": [], "hand_right_keypoints_2d": []}
    return json.dumps({"version": 1.3, "people": [person] * people}).encode()


class FrontEndTest(CliTest):
    """Has talk.wav (4 s) and talk.txt, and weights files that all tests share."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.shared = folder.name

    def setUp(self):
        super().setUp()
        os.remove(self.path("input.npz"))
        self.audio = self.write("talk.wav", wav(voice(4, 8000), 8000))
        self.words = self.write("talk.txt", lines(WORDS))

    def weights(self, *names):
        if len(names) == 1:
            return tiny_weights.make(self.shared, names[0])
        return tiny_weights.make_bundle(self.shared, *names)

    def talker(self, *names):
        """Weights of ZS-MSTM, with others beside it in the file, and a style for it."""
        weights = self.weights(*names)
        style = weights + ".style"
        if not os.path.exists(style):
            random = np.random.default_rng(0)
            widths = {"speech": 12, "text": 16, "pose": 6, "face": 4}
            if names[0] != "zs2":
                del widths["face"]
            clip = {"style_" + name: random.standard_normal((16, n)).astype(np.float32)
                    for name, n in widths.items()}
            if names[0] == "zs2":
                clip["style_tags"] = np.eye(1, 3, dtype=np.float32)
            clip = self.save("clip.npz", clip)
            network = ["--network", names[0]] if len(names) > 1 else []
            self.good("style", weights, clip, "-o", style, *network)
            os.remove(clip)
        return weights, "--style", style

    def write(self, name, data):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        return super().write(name, data)

    def write_poses(self, folder, frames, gaps=()):
        for i in range(frames):
            self.write(f"{folder}/a_{i:012d}_keypoints.json", pose_frame(i, int(i not in gaps)))
        return self.path(folder)

    def write_speaker(self, folder="anna"):
        """A folder with a recording, words and a folder of 45 poses: 3 s."""
        self.write(f"{folder}/anna.wav", wav(voice(3, 8000), 8000))
        self.write(f"{folder}/anna.txt", lines(WORDS[:6]))
        self.write(f"{folder}/README.md", b"Hello there, this is Anna.\n")
        self.write_poses(f"{folder}/poses", 45)
        return self.path(folder)

    def load(self, name):
        with np.load(self.path(name)) as arrays:
            return {key: arrays[key] for key in arrays.files}

    def report(self, *arguments, **options):
        """Runs with --json and gives the report."""
        return json.loads(self.good(*arguments, "--json", **options))

    def assert_same(self, got, want, names=None):
        names = sorted(want) if names is None else names
        for name in names:
            np.testing.assert_array_equal(got[name], want[name], err_msg=name)

    def assert_says(self, lines_, *texts):
        for text in texts:
            self.assertTrue(any(text in line for line in lines_), (text, lines_))
