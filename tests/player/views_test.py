"""--html, --svg and --mp4 of infer-cli: what is written, and that bad input leaves nothing behind.

usage: views_test.py INFER_CLI GOLDENS
"""
import base64
import json
import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from cli_harness import CliTest, golden  # noqa: E402

import numpy as np  # noqa: E402


class ViewsTest(CliTest):

    def test_views_are_written_and_told(self):
        out = self.good(self.WEIGHTS, self.input, "--html", "a.html", "--svg", "a.svg", "--json")
        views = json.loads(out)["views"]
        self.assertEqual([view.split(":")[0] for view in views], ["a.html", "a.svg"])
        self.assertIn("wrote  a.html: ", self.good(self.WEIGHTS, self.input, "--html", "a.html"))
        with open(self.path("a.svg"), encoding="utf-8") as file:
            self.assertTrue(file.read().startswith("<svg "))

    def test_the_page_holds_what_was_written(self):
        self.good(self.WEIGHTS, self.input, "-o", "out.npz", "--html", "a.html")
        with open(self.path("a.html"), encoding="utf-8") as file:
            page = file.read()
        data = json.loads(page.split('id="data">')[1].split("</script>")[0])
        body = data["takes"][0]["body"]
        pose = np.load(self.path("out.npz"))["pose"]
        numbers = np.frombuffer(base64.b64decode(body["numbers"]), "<i2").reshape(len(pose), -1)
        shown = body["offset"] + body["scale"] * numbers
        neck = [i for i, source in enumerate(body["sources"]) if source == 0]
        for column in range(pose.shape[1]):
            want = 0 if column % len(body["sources"]) in neck else pose[:, column]
            self.assertLess(np.abs(shown[:, column] - want).max(), 0.25)
        self.assertFalse(data["trained"])

    def test_the_same_run_gives_the_same_page(self):
        pages = []
        for name in ("a.html", "b.html"):
            self.good(self.WEIGHTS, self.input, "--html", name)
            with open(self.path(name), "rb") as file:
                pages.append(file.read())
        self.assertEqual(*pages)

    def test_source_and_target(self):
        self.good(self.WEIGHTS, self.input, "-o", "out.npz")
        pose = np.load(self.path("out.npz"))["pose"]
        self.save("longer.npz", {"pose": np.concatenate([pose, pose])})
        self.good(self.WEIGHTS, self.input, "--html", "a.html", "--source", "longer.npz", "--target",
                  "out.npz")
        with open(self.path("a.html"), encoding="utf-8") as file:
            page = file.read()
        takes = json.loads(page.split('id="data">')[1].split("</script>")[0])["takes"]
        self.assertEqual([take["role"] for take in takes], ["source", "prediction", "target"])
        self.assertEqual([take["frames"] for take in takes], [2 * len(pose), len(pose), len(pose)])

    def test_bad_input_leaves_nothing(self):
        self.bad(self.WEIGHTS, self.input, "--html", "no/such/a.html", says=["no/such/a.html"])
        self.bad(self.WEIGHTS, self.input, "--html", self.folder, says=["is a directory"])
        self.bad(self.WEIGHTS, self.input, "--source", self.input, says=["expected --html"])
        self.save("narrow.npz", {"pose": np.zeros((8, 4), np.float32)})
        self.bad(self.WEIGHTS, self.input, "--html", "a.html", "--target", "narrow.npz",
                 says=["narrow.npz", "pose"])
        self.save("other.npz", {"nose": np.zeros((8, 4), np.float32)})
        self.bad(self.WEIGHTS, self.input, "--svg", "a.svg", "--source", "other.npz",
                 says=["other.npz", "pose"])
        self.bad(self.AST_WEIGHTS, golden("ast_cls.npz"), "-o", "o.npz", "--html", "a.html",
                 says=["makes no motion"])

    def test_without_ffmpeg_is_told_at_once(self):
        self.bad(self.WEIGHTS, self.input, "--mp4", "a.mp4", env={"PATH": os.devnull},
                 says=["a.mp4", "ffmpeg was not found"])


if __name__ == "__main__":
    unittest.main()
