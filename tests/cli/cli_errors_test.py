"""infer-cli when things go wrong: one line, exit code 2, nothing half-written.

cli_errors_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import os
import random
import resource
import signal
import subprocess
import time
import unittest

import numpy as np

import zip_maker
from cli_harness import INFER_CLI, CliTest, golden


class BadInputTest(CliTest):

    def bad_arrays(self, change, *says):
        arrays = dict(self.inputs)
        change(arrays)
        self.save("bad.npz", arrays)
        self.bad(self.WEIGHTS, "bad.npz", says=("bad.npz: ", "expected", *says))

    def test_missing_arrays(self):
        for name in self.inputs:
            self.bad_arrays(lambda a, name=name: a.pop(name), name)
        self.save("bad.npz", {"x": np.zeros(3)})
        self.bad(self.WEIGHTS, "bad.npz", says=("speech: missing", "x"))

    def test_wrong_shapes(self):
        for name, array in self.inputs.items():
            for wrong in (array[:, :-1], array[0], array[None], array[:0], np.float32(1)):
                self.bad_arrays(lambda a, n=name, w=wrong: a.update({n: w}), name)
        self.bad_arrays(lambda a: a.update(text=a["text"][:-1]), "text", "frames")
        self.bad_arrays(lambda a: a.update(style_pose=a["style_pose"][:-1]), "style_pose")

    def test_wrong_dtypes(self):
        for dtype, shown in (("i4", "int32"), ("?", "bool"), ("c8", "complex"), ("O", "objects"),
                             ("S4", "strings"), ("M8[s]", "dates")):
            self.bad_arrays(lambda a, d=dtype: a.update(speech=a["speech"].astype("i4").astype(d)),
                            "speech", shown)

    def test_not_finite(self):
        for value, shown in ((np.nan, "NaN"), (np.inf, "infinity"), (-np.inf, "infinity"),
                             (1e300, "out of range")):
            for name in self.inputs:
                def change(arrays, name=name, value=value):
                    arrays[name] = arrays[name].astype("f8")
                    arrays[name][2, 1] = value
                self.bad_arrays(change, name, shown, "2", "1")

    def test_damaged_files(self):
        with open(self.input, "rb") as file:
            data = file.read()
        for size in (0, 1, 30, len(data) // 2, len(data) - 1):
            self.bad(self.WEIGHTS, os.path.basename(self.write("bad.npz", data[:size])),
                     says=("bad.npz: ", "expected"))
        flipped = bytearray(data)
        flipped[len(data) // 2] ^= 1
        self.write("bad.npz", bytes(flipped))
        self.bad(self.WEIGHTS, "bad.npz", says=("bad.npz: ", "CRC"))
        self.write("bad.npz", b"time,x,y\n0,1,2\n")
        self.bad(self.WEIGHTS, "bad.npz", says=("bad.npz: is not a zip",))
        zeros = zip_maker.npy("'<f4'", "(50000000,)", data=bytes(200_000_000))
        self.write("bad.npz", zip_maker.archive([zip_maker.Entry("speech.npy", zeros, method=8)]))
        self.bad(self.WEIGHTS, "bad.npz", says=("bad.npz: speech: ", "bomb"))

    def test_what_is_no_file(self):
        os.mkdir(self.path("folder"))
        os.mkfifo(self.path("pipe"))
        for name in ("folder", "pipe", "missing.npz", "input.npz/x", "/dev/zero", "n" * 300):
            self.bad(self.WEIGHTS, name, "-o", "out.npz", says=("expected",))
            self.bad(name, "input.npz", "-o", "out.npz")
            self.bad("info", name)
        if os.geteuid() != 0:
            self.write("secret.npz", b"")
            os.chmod(self.path("secret.npz"), 0)
            self.bad(self.WEIGHTS, "secret.npz", says=("secret.npz", "Permission denied"))

    def test_names_do_not_reach_the_terminal(self):
        self.bad(self.WEIGHTS, "a\nb\x1b[31m.npz", says=("a\\x0ab\\x1b[31m.npz",))
        self.bad(self.WEIGHTS, b"\xff\xfe.npz", says=("\\xff\\xfe.npz",))
        self.write("bad.npz", zip_maker.archive(
            [zip_maker.Entry("evil\x1b]0;x\x07.npy", zip_maker.npy())]))
        self.bad(self.WEIGHTS, "bad.npz", says=("\\x1b]0;x\\x07",))


class BadWeightsTest(CliTest):

    def test_damaged(self):
        with open(self.WEIGHTS, "rb") as file:
            data = file.read()
        generator = random.Random(7)
        sizes = [0, 1, 63, 64, 65, len(data) // 2, len(data) - 1]
        for size in sizes + [generator.randrange(len(data)) for _ in range(20)]:
            self.write("bad.fb", data[:size])
            self.bad("bad.fb", "input.npz", says=("bad.fb",))
        self.write("bad.fb", data + b"\0" * 64)
        self.bad("bad.fb", "input.npz", says=("bad.fb",))
        for _ in range(60):
            flipped = bytearray(data)
            flipped[generator.randrange(len(data))] ^= 1 << generator.randrange(8)
            self.write("bad.fb", bytes(flipped))
            self.bad("bad.fb", "input.npz", says=("bad.fb",))

    def test_foreign(self):
        for name, data in (("zip", zip_maker.npz(zip_maker.npy())), ("text", b"weights\n" * 100),
                           ("zeros", bytes(4096)), ("tflite", b"\x1c\0\0\0TFL3" + bytes(4000)),
                           ("onnx", b"\x08\x07\x12\x07pytorch" + bytes(4000))):
            self.write(name, data)
            self.bad(name, "input.npz", says=(name + ": ",))
            self.bad("info", name, says=(name + ": ",))

    def test_of_another_kind(self):
        self.bad("style", self.AST_WEIGHTS, "input.npz", "-o", "a.style", says=("AST", "style"))
        self.bad(self.AST_WEIGHTS, "input.npz", "--style", "input.npz", says=("AST", "style"))
        self.bad(self.WEIGHTS, "input.npz", "--network", "nobody", says=("nobody",))
        self.bad("info", self.WEIGHTS, "--network", "nobody", says=("nobody",))

    def test_style_of_other_weights(self):
        self.good("style", self.WEIGHTS, "input.npz", "-o", "a.style")
        self.bad(golden("style_first.fb"), "input.npz", "--style", "a.style",
                 says=("a.style: weights_checksum: ", "other weights"))
        with np.load(self.path("a.style")) as arrays:
            style = {k: arrays[k] for k in arrays.files}
        style["style"] = style["style"][:-1]
        self.save("short.style", style)
        self.bad(self.WEIGHTS, "input.npz", "--style", "short.style",
                 says=("short.style: style: ", "expected"))
        del style["style"]
        self.save("none.style", style)
        self.bad(self.WEIGHTS, "input.npz", "--style", "none.style", says=("style: missing",))
        clip = {k: v for k, v in self.inputs.items() if k != "style_text"}
        del clip["text"]
        self.save("clip.npz", clip)
        self.bad(self.WEIGHTS, "input.npz", "--style", "clip.npz", says=("clip.npz: text: missing",))
        self.bad("style", self.WEIGHTS, "clip.npz", "-o", "b.style", says=("clip.npz: text",))


class UsageTest(CliTest):

    def test_usage(self):
        for arguments in ((), (self.WEIGHTS,), ("--nonsense",), ("info",), ("style", self.WEIGHTS),
                          ("style", self.WEIGHTS, "input.npz"), ("info", "a", "b"),
                          (self.WEIGHTS, "input.npz", "--threads", "0"),
                          (self.WEIGHTS, "input.npz", "--threads", "1e9"),
                          (self.WEIGHTS, "input.npz", "--threads"),
                          (self.WEIGHTS, "input.npz", "--repeat", "-1"),
                          (self.WEIGHTS, "input.npz", "--repeat", "many"),
                          (self.WEIGHTS, "input.npz", "-o")):
            self.bad(*arguments, says=("command line: ", "expected"))
        for isa in ("mmx", "AVX2", "neon\n"):
            self.bad(self.WEIGHTS, "input.npz", "--isa", isa, says=("--isa", "expected"))


def limit_file_size():
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))


class OutputTest(CliTest):

    def setUp(self):
        super().setUp()
        self.save("out.npz", {"old": np.arange(5)})

    def test_forbidden_places(self):
        os.mkdir(self.path("folder"))
        for place in ("folder", "folder/", "missing/out.npz", "/proc/out.npz", "/dev/full",
                      "input.npz/out.npz", "n" * 300):
            self.bad(self.WEIGHTS, "input.npz", "-o", place, says=("written",) if place == "/dev/full"
                     else ())
            self.bad("style", self.WEIGHTS, "input.npz", "-o", place)

    def test_size_limit(self):
        self.bad(self.WEIGHTS, "input.npz", "-o", "out.npz", "--taps", preexec_fn=limit_file_size,
                 says=("out.npz: ", "File too large"))

    def test_standard_output_that_is_gone(self):
        report = ("info", self.WEIGHTS)
        with open("/dev/full", "wb") as full:
            self.bad(*report, stdout=full, says=("standard output",))
        self.bad(*report, stdout=None, preexec_fn=lambda: os.close(1), says=("standard output",))
        reader, writer = os.pipe()
        os.close(reader)
        self.bad(*report, stdout=writer, says=("standard output", "Broken pipe"))
        os.close(writer)

    def test_closed_streams_do_not_mix_with_the_output(self):
        done = self.run_cli(self.WEIGHTS, "input.npz", "-o", "new.npz", stdout=None,
                            preexec_fn=lambda: [os.close(fd) for fd in (0, 1)])
        self.assertEqual(done.returncode, 2)
        with np.load(self.path("new.npz")) as arrays:  # complete: only the report was lost
            self.assertIn("pose", arrays.files)

    def test_read_only_folder(self):
        if os.geteuid() == 0:
            self.skipTest("nothing is forbidden to root")
        os.chmod(self.folder, 0o500)
        self.addCleanup(os.chmod, self.folder, 0o700)
        self.bad(self.WEIGHTS, "input.npz", "-o", "new.npz", says=("new.npz", "Permission denied"))

    def test_killed_at_any_time(self):
        """The output is the old file or the new one, at every moment."""
        repeats = 40
        frames = [np.tile(self.inputs[k], (repeats, 1)) for k in ("speech", "text")]
        self.save("long.npz", {**self.inputs, "speech": frames[0], "text": frames[1]})
        command = [INFER_CLI, self.WEIGHTS, "long.npz", "-o", "out.npz", "--taps"]
        begin = time.monotonic()
        subprocess.run(command, cwd=self.folder, stdout=subprocess.DEVNULL, check=True)
        whole = time.monotonic() - begin
        complete = self.snapshot()["out.npz"]
        generator = random.Random(11)
        old = new = 0
        for attempt in range(300):
            self.save("out.npz", {"old": np.arange(5)})
            with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL) as process:
                time.sleep(generator.uniform(0, 1.2 * whole))
                process.send_signal((signal.SIGKILL, signal.SIGTERM, signal.SIGINT)[attempt % 3])
            if self.snapshot()["out.npz"] == complete:
                new += 1
                continue
            old += 1
            with np.load(self.path("out.npz")) as arrays:
                self.assertEqual(arrays.files, ["old"])
        self.assertGreater(old, 0)
        self.assertGreater(new, 0)
        # What a kill between link and rename left, the next run removes.
        subprocess.run(command, cwd=self.folder, stdout=subprocess.DEVNULL, check=True)
        self.assertEqual(self.listing(), ["input.npz", "long.npz", "out.npz"])


if __name__ == "__main__":
    unittest.main()
