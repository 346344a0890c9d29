"""Small weights through infer-cli: int8 networks against the same arithmetic in NumPy, byte for
byte where it is all whole numbers and float32, and on every instruction set; quantise itself.

Usage: quantised_test.py INFER_CLI GOLDENS
"""

import json
import sys
import unittest

from cli_harness import INFER_CLI, ROOT, CliTest, golden

import numpy as np

sys.path.insert(0, ROOT)
try:
    from converters import export, networks, quantised, weights_file
    from converters.__main__ import main
    from converters.random_weights import random_weights
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

F = np.float32


def quantise_rows(x):
    """Whole numbers and the scale of each row: what the engine does with its activations."""
    largest = np.abs(x).max(axis=1, keepdims=True)
    return np.rint(x * (F(127) / largest)).astype(np.int64), largest / F(127)


def linear(x, w, bias):
    q, scale = quantise_rows(x.astype(F))
    sums = (q @ w.values.reshape(len(w.values), -1).T.astype(np.int64)).astype(F)
    return sums * scale * w.scale + bias


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


class QuantisedTest(CliTest):
    def isas(self):
        return json.loads(self.good("--version", "--json"))["available_isas"]

    def make(self, kind, config, change):
        """A file of random weights of which those that `change` (name -> function) names change."""
        network = networks.complete(kind, {"config": config})
        tensors = random_weights(network, 3)
        tensors = {name: change(name)(x) if change(name) else x for name, x in tensors.items()}
        path = self.path("weights.fb")
        export.write(path, network, tensors, {}, False, [])
        return path, tensors

    def run_on(self, isa, weights, inputs):
        source, target = self.save("in.npz", inputs), self.path(f"out.{isa}.npz")
        self.good(weights, source, "-o", target, "--isa", isa)
        with np.load(target) as arrays:
            return {name: arrays[name] for name in arrays.files}

    def test_linear_is_exact_everywhere(self):
        """A discriminator is two products and a LeakyReLU: int8 has the same bits as NumPy."""
        config = {"rows": 3, "d_content": 53, "d_style": 37, "layers": 1, "hidden": 41,
                  "pool": "First"}
        weights, w = self.make("discriminator", config,
                               lambda name: quantised.to_int8 if "weight" in name else None)
        content = np.random.default_rng(1).standard_normal((3, 53)).astype(F)
        x = linear(content[:1], w["layers.0.weight"], w["layers.0.bias"])
        x = np.where(x < 0, F(0.2) * x, x)
        want = linear(x, w["output.weight"], w["output.bias"])
        for isa in self.isas():
            got = self.run_on(isa, weights, {"content": content})["style"]
            np.testing.assert_array_equal(got.reshape(want.shape), want, err_msg=isa)

    def test_lstm(self):
        """The classifier: three gates' functions are not exact, the recurrence is quantised."""
        config = {"frames": 7, "d_in": 13, "layers": 1, "hidden": 45}
        weights, w = self.make("classifier", config,
                               lambda name: quantised.to_int8 if "weight" in name else None)
        motion = np.random.default_rng(2).standard_normal((7, 13)).astype(F)
        h, c = np.zeros((1, 45), F), np.zeros((1, 45), F)
        projected = linear(motion, w["lstm.weight_ih_l0"],
                           w["lstm.bias_ih_l0"] + w["lstm.bias_hh_l0"])
        for t, row in enumerate(projected):
            gates = row + (linear(h, w["lstm.weight_hh_l0"], F(0)) if t else 0)
            i, f, g, o = np.split(np.atleast_2d(gates), 4, axis=1)
            c = sigmoid(f) * c + sigmoid(i) * np.tanh(g)
            h = sigmoid(o) * np.tanh(c)
        want = sigmoid(linear(h, w["dense.weight"], w["dense.bias"]))
        for isa in self.isas():
            got = self.run_on(isa, weights, {"motion": motion})["strength"]
            # A hidden unit that lies between two whole numbers may fall to either side.
            np.testing.assert_allclose(got.ravel(), want.ravel(), atol=1e-4, err_msg=isa)

    def test_types_where_nothing_takes_them(self):
        for name, change in (("output.bias", quantised.to_bf16),):
            weights, _ = self.make(
                "discriminator", {"rows": 3, "d_content": 5, "d_style": 4},
                lambda key, name=name, change=change: change if key == name else None)
            done = self.run_cli("info", weights)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"tensor {name}: (4,) bfloat16, expected (4,) float32",
                          str(done.stderr))

    def test_quantise_and_bundle(self):
        made = {}
        for case, kind in (("ast_cls", "int8"), ("classifier_one_layer", "bf16")):
            made[case] = self.path(f"{case}.fb")
            self.assertEqual(0, main(["quantise", golden(case + ".fb"), "--to", kind, "-o",
                                      made[case], "--infer-cli", INFER_CLI]))
        bundle, again = self.path("bundle.fb"), self.path("again.fb")
        self.assertEqual(0, main(["bundle", *made.values(), "-o", bundle]))
        self.good("check", bundle)
        text = self.good("info", bundle)
        for part in ("bfloat16", "int8", "weights in int8"):
            self.assertIn(part, text)
        # Of a bundle as of a file with one network.
        both = self.path("both.fb")
        self.assertEqual(0, main(["bundle", *map(golden, ("ast_cls.fb", "classifier_one_layer.fb")),
                                  "-o", both]))
        self.assertEqual(0, main(["quantise", both, "--to", "bf16", "-o", again, "--infer-cli",
                                  INFER_CLI]))
        self.good("check", again)
        types = {t.dtype for t in weights_file.read(again).tensors.values()
                 if isinstance(t, quantised.Quantised)}
        self.assertEqual(types, {"BF16"})

    def test_what_breaks_the_guard_stays_wider(self):
        source, target = golden("model1_vector.fb"), self.path("small.fb")
        self.assertEqual(0, main(["quantise", source, "--to", "int8", "-o", target,
                                  "--infer-cli", INFER_CLI]))
        file = weights_file.read(target)
        kinds = {name: t.dtype for name, t in file.tensors.items()
                 if isinstance(t, quantised.Quantised)}
        self.assertIn("I8", kinds.values())
        wider = file.provenance["recipe"].partition("weights in int8, ")[2]
        self.assertTrue(wider)
        for name, tensor in file.tensors.items():
            module = name.partition(".weight")[0]
            if len(tensor.shape) > 1 and "weight" in name:
                said = module in wider.replace(",", " ").split()
                self.assertEqual(said, kinds.get(name) != "I8", name)


if __name__ == "__main__":
    unittest.main()
