"""infer-cli style: taking, showing, mixing, comparing and mapping styles, against NumPy.

style_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import html.parser
import json
import os
import shutil
import subprocess
import unittest

import numpy as np

from cli_harness import CliTest, golden

PARTS = ["speech and text", "pose", "face", "dialog acts"]


def cosine(x, y):
    lengths = np.linalg.norm(x) * np.linalg.norm(y)
    return None if lengths == 0 else 1 - x @ y / lengths


def text_of(array):
    return array.astype(np.uint8).tobytes()


class Page(html.parser.HTMLParser):
    """What a gallery holds: its data, and the addresses that it asks for."""

    def __init__(self, text):
        super().__init__()
        self.data, self.inside, self.addresses, self.tags = "", False, [], []
        self.feed(text)
        self.json = json.loads(self.data)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.inside = tag == "script" and ("id", "data") in attributes
        self.addresses += [v for k, v in attributes if k in ("src", "href")]

    def handle_endtag(self, tag):
        self.inside = False

    def handle_data(self, data):
        if self.inside:
            self.data += data


class StyleTest(CliTest):
    """Of ZS-MSTM 2.0, whose styles have all four parts."""

    CASE = "zs_mstm2_parallel"

    def setUp(self):
        super().setUp()
        self.weights = golden(self.CASE + ".fb")
        with np.load(golden(self.CASE + ".npz")) as arrays:
            self.clip = {n: arrays[n] for n in arrays.files if n.startswith("style_")}
        self.save("clip.npz", self.clip)

    def load(self, name):
        with np.load(self.path(name)) as arrays:
            return {key: arrays[key] for key in arrays.files}

    def extract(self, *clips, output="a.style", weights=None):
        self.good("style", "extract", weights or self.weights, *clips, "-o", output)
        return self.load(output)

    def styles(self, rows, names=None):
        """Files with the values `rows`, otherwise as infer-cli makes them."""
        made = self.extract("clip.npz", output="first.style")
        names = names or [f"s{i}.style" for i in range(len(rows))]
        for name, row in zip(names, rows):
            self.save(name, {**made, "style": np.asarray(row, np.float32)})
        return names

    def random_styles(self, count, seed=1):
        width = len(self.extract("clip.npz", output="first.style")["style"])
        return np.random.default_rng(seed).normal(size=(count, width)).astype(np.float32)

    # extract

    def test_extract_is_what_the_network_says(self):
        with np.load(golden(self.CASE + ".npz")) as arrays:
            want = arrays["style"]
        made = self.extract("clip.npz")
        np.testing.assert_allclose(made["style"], want, rtol=0, atol=1e-4 * np.abs(want).max())
        self.assertEqual(text_of(made["made_of"]), b"clip.npz\0")
        self.assertEqual(made["made_of_share"], [1])
        self.assertEqual(made["parts"].sum(), len(made["style"]))
        tags = self.clip["style_tags"].mean(axis=0)
        np.testing.assert_allclose(made["style"][-len(tags):], tags, atol=1e-6)
        self.good("style", self.weights, "clip.npz", "-o", "old.style")  # the older spelling
        files = self.snapshot()
        self.assertEqual(files["a.style"], files["old.style"])

    def test_extract_from_clips_is_the_mean_of_their_segments(self):
        rng = np.random.default_rng(3)
        segments = len(self.clip["style_tags"])
        frames = len(self.clip["style_speech"]) // segments
        other = {n: rng.normal(size=(3, *a.shape[1:]) if n == "style_tags" else
                               (3 * frames, *a.shape[1:])).astype(np.float32)
                 for n, a in self.clip.items()}
        self.save("other.npz", other)
        self.save("both.npz", {n: np.concatenate([self.clip[n], other[n]]) for n in other})
        os.mkdir(self.path("folder"))
        os.rename(self.path("other.npz"), self.path("folder/other.npz"))
        made = self.extract("clip.npz", "folder/", output="mean.style")
        want = self.extract("both.npz", output="both.style")["style"]
        np.testing.assert_allclose(made["style"], want, rtol=0, atol=2e-6 * np.abs(want).max())
        self.assertEqual(text_of(made["made_of"]), b"clip.npz\0folder\0")
        np.testing.assert_array_equal(made["made_of_segments"], [segments, 3])
        np.testing.assert_allclose(made["made_of_share"],
                                   [segments / (segments + 3), 3 / (segments + 3)], rtol=1e-6)

    def test_style_of_one_network_serves_it_alone(self):
        made = self.extract("clip.npz")
        made["network"] = np.frombuffer(b"another", np.uint8).astype(np.int32)
        self.save("b.style", made)
        with np.load(golden(self.CASE + ".npz")) as arrays:
            self.save("input.npz", {n: arrays[n] for n in ("speech", "text")})
        self.good(self.weights, "input.npz", "--style", "a.style", "-o", "o.npz")
        self.bad(self.weights, "input.npz", "--style", "b.style", says=("b.style: network", "another"))

    # info

    def test_info(self):
        made = self.extract("clip.npz")
        info = json.loads(self.good("style", "info", "a.style", "--json"))[0]
        low, high = made["weights_checksum"].view(np.uint32)
        self.assertEqual(info["weights_checksum"], f"{high:08x}{low:08x}")
        self.assertIn(info["weights_checksum"], self.good("info", self.weights))
        style = made["style"].astype(np.float64)
        self.assertAlmostEqual(info["norm"], np.linalg.norm(style), places=9)
        self.assertEqual([p["name"] for p in info["parts"]], PARTS)
        self.assertEqual([p["width"] for p in info["parts"]], made["parts"].tolist())
        for part in info["parts"]:
            values = style[part["begin"]:part["begin"] + part["width"]]
            self.assertAlmostEqual(part["norm"], np.linalg.norm(values), places=9)
        text = self.good("style", "info", self.weights, "a.style")
        for word in ("a.style", "those of", "speech and text", "100.0 % clip.npz"):
            self.assertIn(word, text)

    def test_files_of_before_and_their_parts(self):
        made = self.extract("clip.npz")
        self.save("old.style", {n: made[n] for n in ("style", "weights_checksum")})
        info = json.loads(self.good("style", "info", "old.style", "--json"))[0]
        self.assertEqual((info["parts"], info["made_of"], info["network"]), ([], [], ""))
        info = json.loads(self.good("style", "info", "old.style", self.weights, "--json"))[0]
        self.assertEqual([p["width"] for p in info["parts"]], made["parts"].tolist())
        self.assertIn("not known", self.good("style", "info", "old.style"))

    # blend

    def test_blend(self):
        rows = self.random_styles(3)
        names = self.styles(rows)
        exact = rows.astype(np.float64)
        for weights, want, note in (
                (("0.7", "0.3"), 0.7 * exact[0] + 0.3 * exact[1], False),
                (("2", "1", "1"), (2 * exact[0] + exact[1] + exact[2]) / 4, True),
                (("1.5", "-0.5"), 1.5 * exact[0] - 0.5 * exact[1], True),
                (("0", "1"), exact[1], False), (("1e-3", "1e-3"), exact[:2].mean(axis=0), True)):
            given = [f"{n}:{w}" for n, w in zip(names, weights)]
            report = json.loads(self.good("style", "blend", *given, "-o", "c.style", "--json"))
            self.assertEqual(bool(report["notes"]), note, report["notes"])
            np.testing.assert_allclose(self.load("c.style")["style"], want, rtol=2e-7, atol=1e-7)
        self.good("style", "blend", *names, "-o", "mean.style")
        np.testing.assert_allclose(self.load("mean.style")["style"], exact.mean(axis=0), rtol=2e-7,
                                   atol=1e-7)
        self.assertEqual(self.snapshot()["mean.style"], self.again("blend", *names))

    def again(self, *arguments):
        self.good("style", *arguments, "-o", "again.style")
        return self.snapshot()["again.style"]

    def test_blend_of_blends_tells_the_clips(self):
        a = self.extract("clip.npz")
        self.save("b.style", {n: a[n] for n in ("style", "weights_checksum")})
        self.good("style", "blend", "a.style:0.5", "b.style:0.5", "-o", "c.style")
        self.good("style", "blend", "c.style:0.5", "a.style:0.5", "-o", "d.style")
        made = json.loads(self.good("style", "info", "d.style", "--json"))[0]["made_of"]
        self.assertEqual([(m["name"], m["share"]) for m in made],
                         [("clip.npz", 0.25), ("b.style", 0.25), ("clip.npz", 0.5)])
        with np.load(golden(self.CASE + ".npz")) as arrays:
            self.save("input.npz", {n: arrays[n] for n in ("speech", "text")})
        self.good(self.weights, "input.npz", "--style", "d.style", "-o", "o.npz")

    def test_odd_names(self):
        row = self.random_styles(1)[0]
        for name in ("a:b.style", "ü 日.style", "<script>alert(1)<", "-", "new\nline", "a\x1b[31m",
                     "x:2", os.fsdecode(b"\xff\xc3.style")):
            self.styles([row], ["./" + name])
            self.good("style", "blend", f"./{name}:1", "-o", "c.style")
            np.testing.assert_array_equal(self.load("c.style")["style"], row)
            text = self.good("style", "info", "./" + name)
            self.assertFalse([c for c in text if ord(c) < 0x20 and c != "\n"], text)
            json.loads(self.good("style", "info", "./" + name, "--json"))
            self.good("style", "gallery", "./" + name, "c.style", "-o", "g.html")
            with open(self.path("g.html"), encoding="utf-8") as file:
                text = file.read()
            page = Page(text)
            shown = os.fsencode(name.removesuffix(".style")).decode("utf-8", "replace")
            self.assertEqual(page.json["names"][0], shown)
            self.assertEqual(page.tags.count("script"), 2)

    # distance

    def test_distance(self):
        rows = self.random_styles(4)
        parts = self.load("first.style")["parts"].tolist()
        rows[1, -parts[3]:] = 0  # no dialog acts
        rows[3] = rows[2]
        names = self.styles(rows)
        report = json.loads(self.good("style", "distance", *names, "--json"))
        self.assertEqual(report["names"], ["s0", "s1", "s2", "s3"])
        self.assertEqual([p["name"] for p in report["parts"]], ["style"] + PARTS)
        begin = 0
        for part in report["parts"]:
            if part["name"] == "style":
                values = rows.astype(np.float64)
            else:
                values = rows[:, begin:begin + part["width"]].astype(np.float64)
                begin += part["width"]
            self.check_distances(values, part)
        self.assertIsNone(report["parts"][4]["cosine"][0][1])
        text = self.good("style", "distance", *names)
        self.assertIn("dialog acts, Euclidean distance", text)

    def check_distances(self, values, part, tolerance=1e-12):
        for i, x in enumerate(values):
            for j, y in enumerate(values):
                self.assertAlmostEqual(part["euclidean"][i][j], np.linalg.norm(x - y),
                                       delta=tolerance * np.linalg.norm(x - y))
                want, got = cosine(x, y), part["cosine"][i][j]
                if want is None:
                    self.assertIsNone(got)
                else:
                    self.assertAlmostEqual(got, want, delta=max(tolerance, 1e-12))

    # gallery

    def gallery(self, *names):
        self.good("style", "gallery", self.weights, *names, "-o", "g.html")
        with open(self.path("g.html"), encoding="utf-8") as file:
            return Page(file.read())

    def values(self, rows):
        widths = self.load("first.style")["parts"]
        ends = np.cumsum(widths)
        return [rows.astype(np.float64)] + [rows[:, e - w:e].astype(np.float64)
                                            for e, w in zip(ends, widths)]

    def test_gallery_components(self):
        rows = self.random_styles(7)
        page = self.gallery(*self.styles(rows))
        self.assertEqual([a for a in page.addresses if not a.startswith("data:")], [])
        self.assertIs(page.json["trained"], False)
        for part, values in zip(page.json["parts"], self.values(rows)):
            self.assertIsNone(part["neighbours"])
            centred = values - values.mean(axis=0)
            u, s, _ = np.linalg.svd(centred, full_matrices=False)
            np.testing.assert_allclose(part["explained"], (s ** 2 / (s ** 2).sum())[:2], atol=1e-7)
            got = np.array(part["components"])
            for axis in range(2):
                want = u[:, axis] * s[axis]
                want *= np.sign(want[np.argmax(np.abs(want))])
                np.testing.assert_allclose(got[:, axis], want, atol=1e-6 * s[0])
            self.check_distances(values, part, 1e-6)
            np.testing.assert_allclose(part["norms"], np.linalg.norm(values, axis=1), rtol=1e-6)

    def test_gallery_of_equal_and_of_two(self):
        row = self.random_styles(1)[0]
        page = self.gallery(*self.styles([row] * 12))
        for part in page.json["parts"]:
            self.assertTrue(np.isfinite(np.array(part["neighbours"])).all())
            np.testing.assert_array_equal(part["components"], np.zeros((12, 2)))
        part = self.gallery(*self.styles(self.random_styles(2))).json["parts"][0]
        self.assertAlmostEqual(part["explained"][0], 1)
        self.assertEqual(part["components"][0][1], 0)

    def test_gallery_neighbours(self):
        """The map's divergence by the definition, and that it is a minimum."""
        rng = np.random.default_rng(5)
        rows = self.random_styles(18)
        rows += 4 * rng.normal(size=(3, rows.shape[1])).astype(np.float32)[np.arange(18) % 3]
        names = self.styles(rows)
        page = self.gallery(*names)
        for part, values in zip(page.json["parts"], self.values(rows)):
            n, y = len(values), np.array(part["neighbours"])
            self.assertAlmostEqual(part["perplexity"], (n - 1) / 3, places=5)
            square = ((values[:, None] - values[None]) ** 2).sum(axis=2)
            p = np.stack([self.neighbourhood(square[i] / square.mean(), i, part["perplexity"])
                          for i in range(n)])
            p = np.maximum((p + p.T) / (2 * n), 1e-12)
            kernel = 1 / (1 + ((y[:, None] - y[None]) ** 2).sum(axis=2))
            np.fill_diagonal(kernel, 0)
            np.fill_diagonal(p, 0)
            q = np.maximum(kernel / kernel.sum(), 1e-12)
            off = ~np.eye(n, dtype=bool)
            self.assertAlmostEqual(part["divergence"], (p[off] * np.log(p[off] / q[off])).sum(),
                                   places=6)
            pull = 4 * (p - q) * kernel
            gradient = (pull[:, :, None] * (y[:, None] - y[None])).sum(axis=1)
            self.assertLess(np.abs(gradient).max(), 2e-5, part["name"])
            np.testing.assert_allclose(y.mean(axis=0), 0, atol=1e-6)
        # Nearest on the map of whole styles: one of the same group.
        y = np.array(page.json["parts"][0]["neighbours"])
        distance = ((y[:, None] - y[None]) ** 2).sum(axis=2) + 1e9 * np.eye(18)
        np.testing.assert_array_equal(distance.argmin(axis=1) % 3, np.arange(18) % 3)
        first = self.snapshot()["g.html"]
        self.gallery(*names)
        self.assertEqual(first, self.snapshot()["g.html"])

    @staticmethod
    def neighbourhood(square, i, perplexity):
        low, high = 1e-9, 1e9
        square = np.where(np.arange(len(square)) == i, np.inf, square)
        for _ in range(200):
            beta = np.sqrt(low * high)
            p = np.exp(-beta * (square - square.min()))
            p /= p.sum()
            entropy = -(p[p > 0] * np.log(p[p > 0])).sum()
            low, high = (beta, high) if entropy > np.log(perplexity) else (low, beta)
        return p

    @unittest.skipIf(shutil.which("chromium") is None, "no chromium")
    def test_gallery_draws(self):
        """A browser that finds a point for every style on every map, before and after a click."""
        self.gallery(*self.styles(self.random_styles(12)))
        with open(self.path("g.html"), "a", encoding="utf-8") as file:
            file.write("<script>window.onerror = (m) => document.body.append('FAILED ' + m);"
                       "document.querySelectorAll('#kinds button')[1].click();"
                       "document.querySelectorAll('circle')[3].dispatchEvent(new Event('focus'));"
                       "byId('theme').click();</script>")
        done = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
                               "--user-data-dir=" + self.path("profile"), self.path("g.html")],
                              capture_output=True, timeout=120, check=True)
        page = done.stdout.decode("utf-8")
        self.assertNotIn("FAILED", page.split("<script>")[-2].split("</script>")[-1])
        self.assertEqual(page.count("<circle"), 5 * 12)
        self.assertEqual(page.count('class="on"'), 5 + 2)
        self.assertIn("t-SNE, perplexity 3.667", page)
        self.assertIn("nearest by cosine distance", page)

    def test_styles_of_the_same_name(self):
        row = self.random_styles(1)[0]
        for folder in ("one", "two"):
            os.mkdir(self.path(folder))
        names = self.styles([row, row], ["one/a.style", "two/a.style"])
        report = json.loads(self.good("style", "distance", *names, "--json"))
        self.assertEqual(report["names"], names)

    # what is wrong

    def test_bad_use(self):
        self.styles(self.random_styles(2))
        for arguments, says in (
                (("info",), "STYLE"), (("blend", "s0.style"), "output"),
                (("distance", "s0.style"), "styles: 1, expected 2"),
                (("gallery", "s0.style", "-o", "g.html"), "styles: 1, expected 2"),
                (("gallery", "s0.style", "s1.style"), "output"), (("extract",), "WEIGHTS"),
                (("extract", self.weights), "CLIP"), (("extract", self.weights, "clip.npz"), "output"),
                (("info", self.weights), "styles: none"), (("nonsense",), "CLIP"),
                (("info", self.weights, self.weights, "s0.style"), "second weights file"),
                (("blend", "s0.style:0", "s1.style:0", "-o", "c.style"), "sum above 0"),
                (("blend", "s0.style:1", "s1.style:-1", "-o", "c.style"), "sum above 0"),
                (("blend", "s0.style:1e9", "-o", "c.style"), "-1000 to 1000"),
                (("blend", "s0.style:nan", "-o", "c.style"), "s0.style:nan"),
                (("blend", "none.style:0.5", "-o", "c.style"), "none.style"),
                (("info", "none.style"), "none.style"), (("info", "."), ""),
                (("distance", "s0.style", "clip.npz"), "clip.npz: style: missing"),
                (("blend", "s0.style", "-o", "no/such/c.style"), "no/such/c.style"),
                (("extract", self.weights, "none/", "-o", "a.style"), "none/"),
                (("extract", golden("ast_cls.fb"), "clip.npz", "-o", "a.style"), "no style")):
            self.bad("style", *arguments, says=(says,))

    def test_bad_files(self):
        good = {**self.extract("clip.npz", output="good.style")}

        def with_(**changes):
            return {n: a for n, a in {**good, **changes}.items() if a is not None}

        i32 = lambda *values: np.array(values, np.int32)
        style = good["style"]
        nan = style.copy()
        nan[1] = np.nan
        for changes, says in (
                (dict(style=nan), "style"), (dict(style=style[None]), "style: 2 dimensions"),
                (dict(style=style[:0]), "style: no values"), (dict(style=None), "style: missing"),
                (dict(style=style[:-1]), "style: "), (dict(weights_checksum=None), "weights_checksum"),
                (dict(weights_checksum=i32(1)), "weights_checksum: expected two"),
                (dict(parts=i32(1, 2)), "parts: 2 widths"), (dict(parts=-good["parts"]), "style: "),
                (dict(parts=i32(2**31 - 1, -2**31, 0, 0)), "style: "),
                (dict(network=i32(300)), "network: holds 300"),
                (dict(network=np.zeros((2, 2), np.int32)), "network: 2 dimensions"),
                (dict(made_of=i32(65, 66)), "made_of: ends within"),
                (dict(made_of=i32(-1, 0)), "made_of: holds -1"),
                (dict(made_of_share=None), "made_of_share: expected one"),
                (dict(made_of_share=np.ones(2, np.float32)), "made_of_share"),
                (dict(made_of_share=np.array([np.inf], np.float32)), "made_of_share"),
                (dict(made_of_segments=i32(-4)), "made_of_segments: holds -4"),
                (dict(made_of_segments=i32()), "made_of_segments")):
            self.save("bad.style", with_(**changes))
            for command in (("info", "bad.style"), ("distance", "good.style", "bad.style"),
                            ("blend", "good.style", "bad.style", "-o", "c.style")):
                self.bad("style", *command, says=("bad.style", says))
        self.write("bad.style", b"PK\x03\x04 not really")
        self.bad("style", "info", "bad.style", says=("bad.style",))
        self.save("huge.style", with_(style=style * 0 + np.float32(3e38)))
        self.bad("style", "blend", "huge.style:1000", "good.style:-999", "-o", "c.style",
                 says=("range of float32",))
        self.assertIn("norm", self.good("style", "info", "huge.style"))
        self.good("style", "gallery", "huge.style", "good.style", "-o", "g.html")
        self.save("zero.style", with_(style=style * 0))
        self.good("style", "distance", "zero.style", "good.style", "huge.style")

    def test_styles_that_do_not_belong_together(self):
        good = self.extract("clip.npz", output="good.style")
        other = good["weights_checksum"] + 1
        self.save("other.style", {**good, "weights_checksum": other})
        self.save("named.style", {**good, "network": np.array([65], np.int32)})
        plain = {n: good[n] for n in ("style", "weights_checksum")}
        self.save("short.style", {**plain, "style": good["style"][:-1]})
        for name, says in (("other.style", "made by weights"), ("named.style", "made by network A"),
                           ("short.style", "values, expected as many as good.style")):
            for command in (("distance",), ("blend", "-o", "c.style"), ("gallery", "-o", "g.html")):
                self.bad("style", *command, "good.style", name, says=(name, says))
        for name in ("other.style", "short.style"):
            self.bad("style", "info", self.weights, name, says=(name, "expected"))


if __name__ == "__main__":
    unittest.main()
