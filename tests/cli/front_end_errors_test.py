"""infer-cli on recordings, words and poses that are damaged, odd or very long.

front_end_errors_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import os
import subprocess
import time
import unittest

import numpy as np

from cli_harness import INFER_CLI
from recordings import WORDS, FrontEndTest, float_wav, lines, voice, wav

MIB = 1 << 20


class SoundTest(FrontEndTest):

    def test_recordings_without_sound(self):
        talker = self.talker("zs1", "bert")
        self.write("empty.wav", b"")
        self.write("header.wav", wav(np.zeros(0), 8000))
        self.write("half.wav", wav(voice(1, 8000), 8000)[:30])
        self.bad(*talker, "empty.wav", says=["empty.wav"])
        self.bad(*talker, "header.wav", says=["header.wav: has no samples"])
        self.bad(*talker, "half.wav", says=["half.wav"])
        self.bad("features", "header.wav", says=["header.wav: has no samples"])
        self.bad(self.weights("model1"), "header.wav", says=["header.wav: has no samples"])

    def finite(self, *arguments):
        report = self.report(*arguments, "-o", "out.npz")
        for name, array in self.load("out.npz").items():
            self.assertTrue(np.isfinite(array).all(), name)
        return report

    def test_silence(self):
        self.write("silence.wav", wav(np.zeros(8000), 8000))
        for weights in (self.talker("zs1", "bert"), (self.weights("model1"),),
                        (self.weights("model2"),), (self.weights("bank"),)):
            self.finite(*weights, "silence.wav")
        self.finite("features", "silence.wav")
        self.assertFalse(self.load("out.npz")["pitch"].any())

    def test_samples_that_are_no_numbers(self):
        samples = voice(2, 8000)
        samples[[3, 4000, 15999]] = np.nan, np.inf, -np.inf
        self.write("nan.wav", float_wav(samples, 8000))
        report = self.finite(*self.talker("zs1", "bert"), "nan.wav")
        self.assert_says(report["notes"], "3 samples")
        self.finite("features", "nan.wav")

    def test_rates_and_channels(self):
        talker = self.talker("zs1", "bert")
        for rate, channels in ((96000, 1), (44100, 6), (4000, 2), (11025, 1)):
            self.write("odd.wav", wav(voice(2, rate), rate, channels))
            report = self.finite(*talker, "odd.wav")
            self.assert_says(report["used"], f"odd.wav: 2.00 s, {rate} Hz")
            self.assertEqual(report["frames"], 30)

    def test_headers_that_lie(self):
        talker = self.talker("zs1", "bert")
        for size in (0xffffffff, 0x7fffffff, 16002):
            self.write("lie.wav", wav(voice(1, 8000), 8000, data_bytes=size))
            report = self.finite(*talker, "lie.wav")
            self.assertEqual(report["frames"], 15)
        whole = wav(voice(1, 8000), 8000)
        for cut in (12, 20, 36, 43, 45, 1001):
            self.write("cut.wav", whole[:cut])
            done = self.run_cli(*talker, "cut.wav", "-o", "cut.npz")
            self.assertIn(done.returncode, (0, 2))
            self.assertEqual(done.stderr.count(b"\n"), int(done.returncode == 2), done.stderr)


class WordsTest(FrontEndTest):

    def run_words(self, text, name="w.txt", **options):
        self.write(name, text if isinstance(text, bytes) else text.encode())
        return self.report(*self.talker("zs1", "bert"), "talk.wav", "--words", name, "-o",
                           "out.npz", **options)

    def test_times_that_cannot_be(self):
        report = self.run_words(lines(WORDS + [("well", 100, 101), ("no", 200, 201)]))
        self.assert_says(report["notes"], "outside")
        self.assertEqual(report["frames"], 60)
        report = self.run_words(lines([("deep", 1.0, 3.0), ("fun", 2.0, 2.5), ("is", 0.2, 0.4)]))
        self.assert_says(report["notes"], "sorted by time", "cut short")
        report = self.run_words(lines([("deep", 1.0, 0.5)]))
        self.assert_says(report["notes"], "ends before it starts")
        self.run_words(lines([("deep", 50, 51)]))
        self.write("years.txt", lines([("deep", 9e6, 9e6 + 1)]))
        self.bad(*self.talker("zs1", "bert"), "years.txt", says=["years.txt: the last word ends"])

    def test_no_words(self):
        for text in ("", " \n", "WEBVTT\n\n", '{"segments": []}'):
            report = self.run_words(text)
            self.assert_says(report["notes"], "the transcript has no words")
            self.bad(*self.talker("zs1", "bert"), "--words", "w.txt",
                     says=["w.txt: no words, expected a recording or words"])
            self.bad(self.weights("bert"), "w.txt", says=["w.txt: has no words"])

    def test_words_of_all_scripts(self):
        for word in ("\U0001f44b\U0001f3fd", "\u202e\u05e9\u05dc\u05d5\u05dd", "\u0645\u0631\u062d\u0628\u0627",
                     "\u4f60\u597d", "a" * 300, "\u0301", "\u2014"):
            self.run_words(f"0.5 1.0 hello\n1.0 2.0 {word}\n2.0 3.0 you\n")
            self.run_words(f"hello {word} you", "plain.txt")
        self.run_words(b"0.5 1.0 hel\xfflo\n1.0 2.0 you\n")

    def test_what_is_no_transcript(self):
        talker = self.talker("zs1", "bert")
        self.write("bytes.bin", b"\x00\x01\x02" * 100)
        self.bad(*talker, "talk.wav", "bytes.bin", says=["bytes.bin: neither a recording"])
        self.bad(*talker, "talk.wav", "--words", "bytes.bin", says=["bytes.bin"])
        self.bad(*talker, "talk.wav", "--words", "talk.wav", says=["talk.wav"])
        self.bad(*talker, "talk.wav", "--words", "none.txt", says=["none.txt"])
        self.write("w.json", b'{"segments": [{"words": [')
        self.bad(*talker, "talk.wav", "w.json", says=["w.json"])
        self.write("evil\n\x1b[2J.json", b"{")
        self.bad(*talker, "talk.wav", "evil\n\x1b[2J.json")


class FilesTest(FrontEndTest):

    def test_two_of_a_kind(self):
        talker = self.talker("zs1", "bert")
        self.write("b.wav", wav(voice(1, 8000), 8000))
        self.write("b.txt", lines(WORDS))
        self.bad(*talker, "talk.wav", "b.wav", says=["b.wav: a second recording beside talk.wav"])
        self.bad(*talker, "talk.txt", "b.txt", says=["a second transcript"])
        self.bad(*talker, "talk.wav", "b.txt", "--words", "talk.txt", says=["a second transcript"])
        self.write("two/a.wav", wav(voice(1, 8000), 8000))
        self.write("two/b.wav", wav(voice(1, 8000), 8000))
        self.bad(*talker, "two", says=["two/b.wav: a second recording beside two/a.wav"])

    def test_folders_with_nothing_usable(self):
        talker = self.talker("zs1", "bert")
        os.mkdir(self.path("empty"))
        self.write("prose/README", b"Hello there, how are you?\n")
        self.write("prose/.hidden.wav", wav(voice(1, 8000), 8000))
        for folder in ("empty", "prose"):
            says = [f"{folder}: nothing in it can be used"]
            self.bad(*talker, folder, says=says)
            self.bad(*talker[:2], folder, "talk.wav", says=says)
            self.bad("style", talker[0], folder, "-o", "x.style", says=says)
            self.bad("features", folder, says=says)
        # But a named file is taken for what it is named as.
        self.good(*talker, "prose/README", "-o", "out.npz")

    def test_files_that_are_no_input(self):
        talker = self.talker("zs1", "bert")
        self.write("face.csv", b"frame, timestamp, confidence, success, pose_Rx, AU01_r\n"
                               b"1, 0, 0.98, 1, 0.1, 0.5\n")
        self.bad(*talker, "face.csv", says=["face.csv: OpenFace's features are no input"])
        report = self.report(*talker, "talk.wav", "face.csv", "-o", "out.npz")
        self.assert_says(report["notes"], "face.csv was not used")
        self.good("features", "face.csv", "-o", "f.npz")
        self.assertEqual(self.load("f.npz")["openface"].shape, (1, 2))
        self.write_poses("poses", 5)
        self.bad(*talker, "poses", says=["poses: poses belong to a --style"])
        self.bad(*talker, talker[0], says=["nothing to be said"])
        self.bad(talker[0], "talk.wav", says=["no --style"])
        self.bad("features", talker[0], says=["nothing to make features of"])

    def test_styles_without_poses(self):
        weights = self.weights("zs1", "bert")
        self.write("bob/bob.wav", wav(voice(1, 8000), 8000))
        self.bad(weights, "talk.wav", "--style", "bob", says=["style: no poses"])
        self.write("broken/a_000000000000_keypoints.json", b'{"people": 3}')
        self.bad("style", weights, "broken", "-o", "x.style", says=["keypoints.json"])


class LongTest(FrontEndTest):

    def peak(self, *arguments):
        """Bytes that a run had at most; VmHWM of its own, which no fork inherits."""
        with subprocess.Popen([INFER_CLI, *arguments], cwd=self.shared, stderr=subprocess.PIPE,
                              stdout=subprocess.DEVNULL) as process:
            most = 0
            while process.poll() is None:
                try:
                    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
                        found = [line for line in file if line.startswith("VmHWM")]
                except OSError:
                    break
                most = max([most] + [int(line.split()[1]) * 1024 for line in found])
                time.sleep(0.005)
            self.assertEqual((process.wait(), process.stderr.read()), (0, b""))
        return most

    def sparse(self, name, seconds, rate):
        path = os.path.join(self.shared, name)
        with open(path, "wb") as file:
            file.write(wav(np.zeros(0), rate, data_bytes=2 * rate * seconds))
            file.truncate(44 + 2 * rate * seconds)
        return path

    @unittest.skipIf("GESTUS_SANITIZED" in os.environ, "sanitizers hold memory back")
    def test_ten_hours_take_no_more_memory_than_a_few_minutes(self):
        talker = self.talker("slow")
        short = self.sparse("short.wav", 300, 2000)
        long = self.sparse("long.wav", 36000, 2000)
        few = self.peak(*talker, short, "-o", "short.npz")
        many = self.peak(*talker, long, "-o", "long.npz")
        with np.load(os.path.join(self.shared, "long.npz")) as out:
            self.assertEqual(out["pose"].shape, (36000, 6))
            # The output is the only thing that grows, and it is held a few times.
            self.assertLess(many - few, 4 * MIB + 8 * out["pose"].nbytes)


if __name__ == "__main__":
    unittest.main()
