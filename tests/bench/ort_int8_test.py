"""The graphs that bench/peers/ort_int8.py writes, evaluated in NumPy beside those that it read.

usage: ort_int8_test.py SOURCE_ROOT
"""
import importlib.util
import pathlib
import sys
import tempfile
import unittest

SKIPPED = 77
if any(importlib.util.find_spec(name) is None for name in ("numpy", "onnx")):
    print("skipped: python3-numpy or python3-onnx is not installed")
    sys.exit(SKIPPED)
sys.path.insert(0, sys.argv[1])

# pylint: disable=wrong-import-position
import numpy as np  # noqa: E402
import onnx  # noqa: E402
from onnx import helper, numpy_helper  # noqa: E402
from bench.peers import ort_int8  # noqa: E402

RNG = np.random.default_rng(1)
ROWS, DEPTH, COLUMNS, TABLE = 7, 64, 24, 40


def normal(*shape):
    return RNG.standard_normal(shape).astype(np.float32)


def evaluate(graph, inputs):
    """Name -> value of everything that the nodes put out; of ONNX 17, what these graphs need."""
    values = {x.name: numpy_helper.to_array(x) for x in graph.initializer} | inputs | {"": None}
    for node in graph.node:
        has = {a.name: helper.get_attribute_value(a) for a in node.attribute}
        outputs = OPERATORS[node.op_type](has, *(values[name] for name in node.input))
        values |= zip(node.output, outputs if isinstance(outputs, tuple) else (outputs,))
    return values


def gemm(has, a, b, c):
    return (a.T if has.get("transA") else a) @ (b.T if has.get("transB") else b) + c


def dynamic_quantize_linear(_, x):
    low, high = min(x.min(), 0), max(x.max(), 0)
    scale = np.float32((high - low) / 255)
    zero = np.uint8(np.rint(-low / scale))
    return np.clip(np.rint(x / scale) + zero, 0, 255).astype(np.uint8), scale, zero


OPERATORS = {
    "Gemm": gemm,
    "MatMul": lambda _, a, b: a @ b,
    "Gather": lambda _, table, ids: table[ids],
    "DynamicQuantizeLinear": dynamic_quantize_linear,
    "MatMulInteger": lambda _, a, b, zero: (a.astype(np.int32) - zero) @ b.astype(np.int32),
    "Cast": lambda _, x: x.astype(np.float32),
    "Mul": lambda _, a, b: a * b,
    "Add": lambda _, a, b: a + b,
    "Transpose": lambda has, x: x.transpose(has["perm"]),
    "DequantizeLinear": lambda _, x, scale: x * scale,
}


def rewritten(nodes, weights):
    """The graph of these nodes, before and after."""
    graph = helper.make_graph(nodes, "g", [], [],
                              [numpy_helper.from_array(x, name) for name, x in weights.items()])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
    with tempfile.TemporaryDirectory() as folder:
        source, target = pathlib.Path(folder, "a.onnx"), pathlib.Path(folder, "b.onnx")
        onnx.save(model, str(source))
        ort_int8.quantise(source, target)
        return model.graph, onnx.load(str(target)).graph


class OrtInt8Test(unittest.TestCase):
    def agree(self, nodes, weights, inputs):
        """Both graphs give nearly the same "out"; the operators of the new one."""
        old, new = rewritten(nodes, weights)
        want, got = evaluate(old, inputs)["out"], evaluate(new, inputs)["out"]
        self.assertEqual(got.shape, want.shape)
        self.assertLess(np.abs(got - want).max(), 0.03 * np.abs(want).max())
        self.assertEqual({x.data_type for x in new.initializer if len(x.dims) > 1},
                         {onnx.TensorProto.INT8})
        return [node.op_type for node in new.node]

    def test_products(self):
        matrix, bias = normal(DEPTH, COLUMNS), normal(COLUMNS)
        x = normal(ROWS, DEPTH)
        for transposed in ("transA", "transB"):
            with self.subTest(transposed):
                node = helper.make_node("Gemm", ["x", "w", "b"], ["out"], **{transposed: 1})
                self.agree([node], {"w": matrix.T if transposed == "transB" else matrix, "b": bias},
                           {"x": x.T if transposed == "transA" else x})
        self.agree([helper.make_node("MatMul", ["x", "w"], ["out"])], {"w": matrix}, {"x": x})

    def test_an_input_is_quantised_once(self):
        nodes = [helper.make_node("MatMul", ["x", name], [f"y{name}"]) for name in "ab"]
        nodes.append(helper.make_node("Add", ["ya", "yb"], ["out"]))
        kinds = self.agree(nodes, {name: normal(DEPTH, COLUMNS) for name in "ab"},
                           {"x": normal(ROWS, DEPTH)})
        self.assertEqual(kinds.count("DynamicQuantizeLinear"), 1)

    def test_products_of_two_inputs_stay(self):
        node = helper.make_node("MatMul", ["x", "y"], ["out"])
        _, new = rewritten([node], {})
        self.assertEqual([node.op_type for node in new.node], ["MatMul"])

    def test_embeddings(self):
        node = helper.make_node("Gather", ["table", "ids"], ["out"])
        self.agree([node], {"table": normal(TABLE, DEPTH)}, {"ids": np.array([3, 0, TABLE - 1])})

    def test_lstm(self):
        """Weights (directions, columns, 4 * hidden) with scales (directions, 4 * hidden)."""
        weights = {"w": normal(2, 4 * 8, DEPTH), "r": normal(2, 4 * 8, 8), "b": normal(2, 8 * 8)}
        node = helper.make_node("LSTM", ["x", "w", "r", "b"], ["out"], hidden_size=8,
                                direction="bidirectional")
        _, new = rewritten([node], weights)
        [node] = new.node
        self.assertEqual((node.domain, node.op_type), ("com.microsoft", "DynamicQuantizeLSTM"))
        known = {x.name: numpy_helper.to_array(x) for x in new.initializer}
        self.assertEqual(list(node.input[3:8]), ["b", "", "", "", ""])
        for at, name in enumerate(("w", "r")):
            values, scale, zero = (known[node.input[i]] for i in (1 + at, 8 + 2 * at, 9 + 2 * at))
            self.assertFalse(zero.any())
            error = values * scale[:, None] - weights[name].transpose(0, 2, 1)
            self.assertTrue((np.abs(error) <= 0.501 * scale[:, None]).all())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
