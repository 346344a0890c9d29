"""What cli_test.py and cli_errors_test.py share: running infer-cli, and making its inputs."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

INFER_CLI = os.path.abspath(sys.argv.pop(1))
GOLDENS = os.path.abspath(sys.argv.pop(1))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CASE = "frame_autoregressive"
INPUTS = ("speech", "text", "style_speech", "style_text", "style_pose")
OUTPUTS = ("pose", "style")


def golden(name):
    return os.path.join(GOLDENS, name)


class CliTest(unittest.TestCase):
    """Each test has a folder of its own with input.npz, a valid input of WEIGHTS."""

    WEIGHTS = golden(CASE + ".fb")
    AST_WEIGHTS = golden("ast_cls.fb")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with np.load(golden(CASE + ".npz")) as arrays:
            self.inputs = {name: arrays[name] for name in INPUTS}
            self.expected = {name: arrays[name] for name in OUTPUTS}
        self.input = self.save("input.npz", self.inputs)

    def path(self, name):
        return os.path.join(self.folder, name)

    def save(self, name, arrays, save=np.savez):
        path = self.path(name)
        with open(path, "wb") as file:
            save(file, **arrays)
        return path

    def write(self, name, data):
        path = self.path(name)
        with open(path, "wb") as file:
            file.write(data)
        return path

    def listing(self):
        return sorted(os.listdir(self.folder))

    def run_cli(self, *arguments, env=None, **options):
        options.setdefault("stdout", subprocess.PIPE)
        options.setdefault("timeout", 120)
        environment = {k: v for k, v in os.environ.items() if k != "GESTUS_ISA"}
        environment.update(env or {})
        return subprocess.run([INFER_CLI, *arguments], stderr=subprocess.PIPE, check=False,
                              env=environment, cwd=self.folder, **options)

    def good(self, *arguments, **options):
        """Runs what must succeed; returns its standard output."""
        done = self.run_cli(*arguments, **options)
        self.assertEqual((done.returncode, done.stderr), (0, b""), done)
        return done.stdout.decode("utf-8")

    def bad(self, *arguments, says=(), **options):
        """Runs what must fail: one line, exit code 2, no file made or changed."""
        before = self.snapshot()
        done = self.run_cli(*arguments, **options)
        line = done.stderr
        self.assertEqual(done.returncode, 2, done)
        self.assertTrue(line.startswith(b"infer-cli: "), line)
        self.assertTrue(line.endswith(b"\n") and line.count(b"\n") == 1, line)
        self.assertLessEqual(len(line), 300)
        self.assertFalse([c for c in line[:-1] if c < 0x20 or c == 0x7f], line)
        text = line.decode("utf-8")
        for word in says:
            self.assertIn(word, text)
        self.assertEqual(self.snapshot(), before)
        return text

    def snapshot(self):
        """Names and contents of all files of the folder."""
        contents = {}
        for name in self.listing():
            path = self.path(name)
            if os.path.isfile(path) and os.access(path, os.R_OK):
                with open(path, "rb") as file:
                    contents[name] = file.read()
            else:
                contents[name] = None
        return contents
