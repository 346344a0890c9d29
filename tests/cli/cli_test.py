"""infer-cli doing its work: outputs, reports, styles, options.

cli_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import json
import os
import pty
import subprocess
import sys
import unittest

import numpy as np

from cli_harness import INFER_CLI, ROOT, CliTest, golden

sys.path.insert(0, ROOT)
from converters import weights_file  # noqa: E402


class RunTest(CliTest):
    """What tests of runs need beside."""

    def load(self, name):
        with np.load(self.path(name)) as arrays:
            return {key: arrays[key] for key in arrays.files}

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def assert_close(self, got, want):
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-4 * np.abs(want).max())


class InferTest(RunTest):

    def test_output_agrees_with_pytorch(self):
        text = self.good(self.WEIGHTS, "input.npz", "-o", "motion.npz")
        out = self.load("motion.npz")
        self.assertEqual(out["pose"].dtype, np.float32)
        self.assert_close(out["pose"], self.expected["pose"])
        self.assertIn("motion.npz", text)
        self.assertIn("UNTRAINED", text)
        self.assertEqual(self.listing(), ["input.npz", "motion.npz"])

    def test_default_output_stands_beside_the_input(self):
        self.good(self.WEIGHTS, self.input)
        self.assertEqual(self.listing(), ["input.npz", "input.out.npz"])

    def test_output_may_replace_the_input(self):
        self.good(self.WEIGHTS, "input.npz", "-o", "input.npz")
        self.assert_close(self.load("input.npz")["pose"], self.expected["pose"])
        self.assertEqual(self.listing(), ["input.npz"])

    def test_input_in_any_spelling_of_numpy(self):
        self.good(self.WEIGHTS, "input.npz", "-o", "plain.npz")
        wide = {k: np.asfortranarray(v.astype(">f8")) for k, v in self.inputs.items()}
        self.save("wide.npz", wide, np.savez_compressed)
        self.good(self.WEIGHTS, "wide.npz", "-o", "wide.out.npz")
        self.assertEqual(self.read("plain.npz"), self.read("wide.out.npz"))

    def test_same_bytes_every_time_and_for_any_threads(self):
        self.good(self.WEIGHTS, "input.npz", "-o", "1.npz")
        for threads in ("1", "2", "3"):
            self.good(self.WEIGHTS, "input.npz", "-o", "n.npz", "--threads", threads)
            self.assertEqual(self.read("1.npz"), self.read("n.npz"))

    def test_every_instruction_set(self):
        for isa in json.loads(self.good("--version", "--json"))["available_isas"]:
            text = self.good(self.WEIGHTS, "input.npz", "-o", "out.npz", "--isa", isa, "--json")
            self.assertEqual(json.loads(text)["isa"], isa)
            self.assert_close(self.load("out.npz")["pose"], self.expected["pose"])
            text = self.good(self.WEIGHTS, "input.npz", "--json", env={"GESTUS_ISA": isa})
            self.assertEqual(json.loads(text)["isa"], isa)

    def test_environment_that_asks_for_too_much_is_noted(self):
        text = self.good(self.WEIGHTS, "input.npz", env={"GESTUS_ISA": "mmx"})
        self.assertIn("GESTUS_ISA=mmx is ignored", text)

    def test_unused_arrays_are_noted_and_not_read(self):
        self.save("more.npz", {**self.inputs, "names": np.array(["not", "numbers"])})
        self.assertIn("names in more.npz was not used", self.good(self.WEIGHTS, "more.npz"))

    def test_partial_segment(self):
        frames = len(self.inputs["speech"])
        longer = {k: np.concatenate([v, v, v[:3]]) if k in ("speech", "text") else v
                  for k, v in self.inputs.items()}
        self.save("longer.npz", longer)
        report = json.loads(self.good(self.WEIGHTS, "longer.npz", "-o", "out.npz", "--json"))
        self.assertEqual(report["frames"], 2 * frames + 3)
        self.assertEqual(self.load("out.npz")["pose"].shape[0], 2 * frames + 3)
        self.assertTrue(report["notes"])

    def test_json_report(self):
        report = json.loads(self.good(self.WEIGHTS, "input.npz", "-o", "out.npz", "--json",
                                      "--profile", "--plan", "--repeat", "5"))
        self.assertFalse(report["trained"])
        self.assertEqual(report["output"], "out.npz")
        shapes = {a["name"]: a["shape"] for a in report["outputs"]}
        self.assertEqual(shapes["pose"], list(self.expected["pose"].shape))
        self.assertEqual(report["repeat"], 5)
        self.assertLessEqual(report["segment_seconds_median"], report["segment_seconds_p99"])
        self.assertGreater(report["times_real_time"], 0)
        self.assertGreater(len(report["profile"]), 5)
        self.assertTrue(report["plan"])

    def test_profile_and_plan_as_text(self):
        text = self.good(self.WEIGHTS, "input.npz", "--profile", "--plan", "--repeat", "3")
        for word in ("p99", "GFLOP/s", "linear", "generator"):
            self.assertIn(word, text)

    def test_progress_on_a_terminal(self):
        arrays = {k: np.tile(v, (40, 1)) if k in ("speech", "text") else v
                  for k, v in self.inputs.items()}
        self.save("long.npz", arrays)
        ours, theirs = pty.openpty()
        with subprocess.Popen([INFER_CLI, self.WEIGHTS, "long.npz", "--repeat", "1000"],
                              cwd=self.folder, stdout=subprocess.DEVNULL, stderr=theirs,
                              env={**os.environ, "TERM": "xterm"}) as process:
            os.close(theirs)
            shown = b""
            try:
                while chunk := os.read(ours, 4096):
                    shown += chunk
            except OSError:  # how Linux says that the other side of a terminal is gone
                pass
        os.close(ours)
        self.assertEqual(process.returncode, 0)
        for word in (b"of 41 segments", b"times real time", b"s left"):
            self.assertIn(word, shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown[-100:])

    def test_taps(self):
        self.good(self.WEIGHTS, "input.npz", "-o", "out.npz", "--taps")
        taps = [name for name in self.load("out.npz") if name.startswith("tap/")]
        self.assertGreater(len(taps), 5)

    def test_locale_does_not_matter(self):
        self.good(self.WEIGHTS, "input.npz", "-o", "a.npz", env={"LC_ALL": "C"})
        self.good(self.WEIGHTS, "input.npz", "-o", "b.npz", env={"LC_ALL": "de_DE.UTF-8"})
        self.assertEqual(self.read("a.npz"), self.read("b.npz"))

    def test_ast_alone_takes_a_bare_npy(self):
        with np.load(golden("ast_cls.npz")) as arrays:
            np.save(self.path("speech.npy"), arrays["speech"])
            want = arrays["embedding"].reshape(1, -1)
        self.good(self.AST_WEIGHTS, "speech.npy")
        self.assert_close(self.load("speech.out.npz")["embedding"], want)


class StyleTest(RunTest):

    def setUp(self):
        super().setUp()
        self.content = {k: v for k, v in self.inputs.items() if not k.startswith("style")}
        self.clip = {k: v for k, v in self.inputs.items() if k.startswith("style_")}
        self.save("content.npz", self.content)
        self.save("clip.npz", self.clip)
        self.good(self.WEIGHTS, "input.npz", "-o", "want.npz")

    def test_style_file_gives_the_same_motion(self):
        text = self.good("style", self.WEIGHTS, "clip.npz", "-o", "anna.style")
        self.assertIn("UNTRAINED", text)
        self.good(self.WEIGHTS, "content.npz", "--style", "anna.style", "-o", "out.npz")
        self.assertEqual(self.read("out.npz"), self.read("want.npz"))

    def test_clip_without_prefixes(self):
        self.save("plain.npz", {k[len("style_"):]: v for k, v in self.clip.items()})
        report = json.loads(self.good("style", self.WEIGHTS, "plain.npz", "-o", "a.style",
                                      "--json"))
        self.assertEqual(report["shape"], list(self.load("a.style")["style"].shape))
        self.good("style", self.WEIGHTS, "clip.npz", "-o", "b.style")
        np.testing.assert_array_equal(self.load("a.style")["style"], self.load("b.style")["style"])

    def test_clip_for_style_option(self):
        self.good(self.WEIGHTS, "content.npz", "--style", "clip.npz", "-o", "out.npz")
        self.assertEqual(self.read("out.npz"), self.read("want.npz"))

    def test_style_option_wins_over_the_input(self):
        other = {**self.inputs, "style_pose": self.inputs["style_pose"] + 1}
        self.save("other.npz", other)
        text = self.good(self.WEIGHTS, "other.npz", "--style", "clip.npz", "-o", "out.npz")
        self.assertIn("style_pose in other.npz was not used", text)
        self.assertEqual(self.read("out.npz"), self.read("want.npz"))


class InfoTest(CliTest):

    def test_text(self):
        text = self.good("info", self.WEIGHTS)
        for word in ("ZS-MSTM 1.0", "UNTRAINED", "parameters", "speech", "mel bins", "ln power",
                     "decoder_mode", "Autoregressive", "ast_content.mel_bins", "pose_lstm"):
            self.assertIn(word, text)

    def test_json(self):
        info = json.loads(self.good("info", self.WEIGHTS, "--json", "--plan"))
        self.assertEqual(info["bytes"], os.path.getsize(self.WEIGHTS))
        self.assertEqual(info["parameters"],
                         sum(int(np.prod(t["shape"])) for t in info["tensors"]
                             if not t["name"].startswith("self_test/")))
        network = info["networks"][0]
        self.assertEqual([a["name"] for a in network["inputs"]][:2], ["speech", "text"])
        self.assertTrue(network["plan"])

    def test_every_golden(self):
        for name in sorted(os.listdir(os.path.dirname(self.WEIGHTS))):
            if name.endswith(".fb"):
                info = json.loads(self.good("info", golden(name), "--json"))
                network = info["networks"][0]
                self.assertGreater(len(network["configuration"]), 3, name)
                self.assertTrue(network["inputs"] and network["outputs"], name)

    def test_pose_source(self):
        """The reading that has no golden, since it changes no number."""
        file = weights_file.read(self.WEIGHTS)
        for source in ("Data", "Normalize"):
            file.networks[0]["config"]["pose_source"] = source
            weights_file.write(self.path("source.fb"), file.networks, file.tensors,
                               file.provenance)
            info = json.loads(self.good("info", "source.fb", "--json"))
            self.assertEqual(info["networks"][0]["configuration"]["pose_source"], source)
            self.assertRegex(self.good("info", "source.fb"), rf"pose_source +{source}\n")

    def test_check(self):
        self.assertIn("passed", self.good("check", self.WEIGHTS))
        report = json.loads(self.good("check", self.WEIGHTS, "--json", "--threads", "2"))
        self.assertEqual(report["networks"][0]["self_test"], "passed")
        self.assertLess(report["networks"][0]["relative_error"], 1e-4)

    def test_check_finds_a_wrong_result(self):
        file = weights_file.read(self.WEIGHTS)
        tensors = {name: array.copy() for name, array in file.tensors.items()}
        tensors[file.networks[0]["self_test"]["output"]] *= 1.01
        weights_file.write(self.path("wrong.fb"), file.networks, tensors, file.provenance)
        self.bad("check", "wrong.fb", says=("wrong.fb", "self-test", "relative error"))

    def test_sampling(self):
        with np.load(golden("model2_text.npz")) as arrays:
            given = self.save("words.npz", {name: arrays[name] for name in ("f0", "text")})
        drawn = {}
        for name, options in (("greedy", ()), ("drawn", ("--temperature", "2", "--seed", "1")),
                              ("again", ("--temperature", "2", "--seed", "1")),
                              ("other", ("--temperature", "2", "--seed", "2")),
                              ("one", ("--temperature", "2", "--top-k", "1"))):
            self.good(golden("model2_text.fb"), given, "-o", name + ".npz", *options)
            with np.load(self.path(name + ".npz")) as arrays:
                drawn[name] = arrays["tokens"].tolist()
        self.assertEqual(drawn["drawn"], drawn["again"])
        self.assertEqual(drawn["greedy"], drawn["one"])
        self.assertNotEqual(drawn["drawn"], drawn["other"])
        self.bad(golden("model2_text.fb"), given, "--temperature", "-1", says=("temperature",))

    def test_help_and_version(self):
        self.assertIn("Exit codes", self.good("--help"))
        self.assertIn("available", self.good("--version"))
        self.assertIn(json.loads(self.good("--version", "--json"))["isa"],
                      ("scalar", "sse2", "neon", "avx2", "avx512", "avx512_vnni",
                       "avx512_bf16", "avx512_amx"))


class ExampleTest(CliTest):
    """python3 -m converters example makes what infer-cli takes, for every kind of network."""

    def test_every_golden(self):
        folder = os.path.dirname(self.WEIGHTS)
        seen = set()
        for name in sorted(os.listdir(folder)):
            kind = name.split("_")[0]
            if not name.endswith(".fb") or kind in seen:
                continue
            seen.add(kind)
            subprocess.run([sys.executable, "-m", "converters", "example", golden(name), "-o",
                            self.path("example.npz")], check=True, capture_output=True, cwd=ROOT)
            self.good(golden(name), "example.npz", "-o", "out.npz")
        self.assertGreaterEqual(seen, {"ast", "autoencoder", "bert", "classifier",
                                       "discriminator", "model1", "model2", "zs"})


class BundleTest(CliTest):
    """Several networks in one file."""

    def setUp(self):
        super().setUp()
        self.bundle = self.path("bundle.fb")
        subprocess.run([sys.executable, "-m", "converters", "bundle", self.WEIGHTS,
                        self.AST_WEIGHTS, "acts=" + golden("bert_classifier.fb"),
                        golden("classifier_one_layer.fb"), "-o", self.bundle],
                       check=True, capture_output=True, cwd=ROOT)

    def test_the_input_tells_which(self):
        alone = self.path("alone.npz")
        for case, weights, kind in (("frame_autoregressive", self.WEIGHTS, "ZS-MSTM 1.0"),
                                    ("ast_cls", self.AST_WEIGHTS, "AST"),
                                    ("classifier_one_layer", golden("classifier_one_layer.fb"),
                                     "classifier"),
                                    ("bert_classifier", golden("bert_classifier.fb"), "BERT")):
            info = json.loads(self.good("info", weights, "--json"))["networks"][0]
            names = [a["name"] for a in info["inputs"] if a["name"] != "style"]
            with np.load(golden(case + ".npz")) as arrays:
                given = self.save("given.npz", {n: arrays[n] for n in names if n in arrays})
            self.assertIn(kind, info["kind"])
            self.good(self.bundle, given, "-o", "bundled.npz")
            self.good(weights, given, "-o", alone)
            with np.load(self.path("bundled.npz")) as got, np.load(alone) as want:
                self.assertEqual(sorted(got.files), sorted(want.files))
                for name in got.files:
                    np.testing.assert_array_equal(got[name], want[name])

    def test_input_of_none(self):
        given = self.save("given.npz", {"music": np.zeros((3, 3), np.float32)})
        self.bad(self.bundle, given, says=("--network", "acts"))
        self.bad(self.bundle, given, "--network", "acts", says=("ids",))

    def test_input_that_cannot_be_listed(self):
        self.bad(self.bundle, "none.npz", says=("none.npz", "No such file"))
        self.bad(self.bundle, self.write("text.npz", b"no archive"), says=("text.npz",))
        with np.load(golden("ast_cls.npz")) as arrays:
            np.save(self.path("bare.npy"), arrays["speech"])
        self.bad(self.bundle, "bare.npy",
                 says=("bare.npy: is a single .npy array, expected an .npz file",))
        self.good(self.bundle, "bare.npy", "--network", "ast", "-o", "out.npz")

    def test_style_and_self_tests(self):
        self.good("style", self.bundle, "input.npz", "-o", "a.style")
        self.good(self.bundle, "input.npz", "--style", "a.style", "-o", "out.npz")
        report = json.loads(self.good("check", self.bundle, "--json"))
        self.assertEqual([n["self_test"] for n in report["networks"]], ["passed"] * 4)


if __name__ == "__main__":
    unittest.main()
