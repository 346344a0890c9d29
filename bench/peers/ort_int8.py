"""Dynamic quantisation of an ONNX model, as ONNX Runtime's own tool does it per output channel.

That tool (onnxruntime.quantization.quantize_dynamic, per_channel=True) is in none of the packages
that are used here, so this does the same to the graphs that export.py writes:

  MatMul, Gemm   DynamicQuantizeLinear of the input (uint8, a scale for all of it) once for all that
                 read it, MatMulInteger with int8 weights, Cast, Mul by both scales, Add of the bias;
                 ONNX Runtime fuses these into MatMulIntegerToFloat or DynamicQuantizeMatMul
  LSTM           com.microsoft DynamicQuantizeLSTM
  Gather         of int8 rows, then DequantizeLinear

Weights are symmetric, without zero points.  Convolutions stay as they are.
"""

import numpy as np
import onnx
from onnx import helper, numpy_helper

_MICROSOFT = "com.microsoft"
_LEAST_GATHERED = 1024  # elements; smaller tables are sizes and the like


def quantise(source, target):
    """Reads the model `source` and writes `target`, both paths."""
    model = onnx.load(str(source))
    _Rewriter(model.graph).run()
    model.opset_import.append(helper.make_opsetid(_MICROSOFT, 1))
    onnx.save(model, str(target))


class _Rewriter:
    def __init__(self, graph):
        self._graph = graph
        self._weights = {x.name: x for x in graph.initializer}
        self._quantised = {}  # input -> names of its values, scale and zero point
        self._nodes = []

    def run(self):
        rules = {"MatMul": self._matmul, "Gemm": self._gemm, "LSTM": self._lstm,
                 "Gather": self._gather}
        for node in self._graph.node:
            rule = rules.get(node.op_type)
            if rule is None or not rule(node):
                self._nodes.append(node)
        del self._graph.node[:]
        self._graph.node.extend(self._nodes)
        self._drop_unread()

    def _matmul(self, node):
        weights = self._array(node.input[1], 2)
        if weights is None:
            return False
        self._product(node.input[0], node.input[1], weights, None, node.output[0])
        return True

    def _gemm(self, node):
        weights = self._array(node.input[1], 2)
        has = {a.name: helper.get_attribute_value(a) for a in node.attribute}
        if weights is None or has.get("alpha", 1.0) != 1.0 or has.get("beta", 1.0) != 1.0:
            return False
        x = node.input[0]
        if has.get("transA"):
            x = self._add("Transpose", [x], f"{node.output[0]}/rows", perm=[1, 0])
        bias = node.input[2] if len(node.input) > 2 else None
        self._product(x, node.input[1], weights.T if has.get("transB") else weights, bias,
                      node.output[0])
        return True

    def _product(self, x, name, weights, bias, out):
        """out = x (M, K) * weights (K, N) + bias (N,)."""
        values, scale = to_int8(weights, 0)
        values = self._initializer(f"{name}/int8", np.ascontiguousarray(values))
        scale = self._initializer(f"{name}/scale", scale)
        x, x_scale, x_zero = self._quantised_input(x)
        product = self._add("MatMulInteger", [x, values, x_zero], f"{out}/int32")
        product = self._add("Cast", [product], f"{out}/unscaled", to=onnx.TensorProto.FLOAT)
        scale = self._add("Mul", [x_scale, scale], f"{out}/scale")
        scaled = self._add("Mul", [product, scale], out if bias is None else f"{out}/unbiased")
        if bias is not None:
            self._add("Add", [scaled, bias], out)

    def _quantised_input(self, x):
        if x not in self._quantised:
            names = [f"{x}/uint8", f"{x}/uint8_scale", f"{x}/uint8_zero"]
            self._nodes.append(helper.make_node("DynamicQuantizeLinear", [x], names))
            self._quantised[x] = names
        return self._quantised[x]

    def _lstm(self, node):
        matrices = [self._array(name, 3) for name in node.input[1:3]]
        if any(x is None for x in matrices):
            return False
        inputs = list(node.input) + [""] * (8 - len(node.input))
        for at, weights in enumerate(matrices, 1):  # (directions, 4 * hidden, columns)
            values, scale = to_int8(weights, 2)
            name = inputs[at]
            inputs[at] = self._initializer(f"{name}/int8",
                                           np.ascontiguousarray(values.transpose(0, 2, 1)))
            inputs += [self._initializer(f"{name}/scale", scale),
                       self._initializer(f"{name}/zero", np.zeros(scale.shape, np.int8))]
        new = helper.make_node("DynamicQuantizeLSTM", inputs, node.output, domain=_MICROSOFT)
        new.attribute.extend(node.attribute)
        self._nodes.append(new)
        return True

    def _gather(self, node):
        table = self._array(node.input[0], 2)
        if table is None or table.size < _LEAST_GATHERED:
            return False
        values, scale = to_int8(table, None)
        name, out = node.input[0], node.output[0]
        rows = self._add("Gather", [self._initializer(f"{name}/int8", values), node.input[1]],
                         f"{out}/int8")
        self._add("DequantizeLinear", [rows, self._initializer(f"{name}/scale", scale)], out)
        return True

    def _array(self, name, rank):
        """The float32 weights of that name and rank, or None."""
        weights = self._weights.get(name)
        if weights is None or len(weights.dims) != rank or (
                weights.data_type != onnx.TensorProto.FLOAT):
            return None
        return numpy_helper.to_array(weights)

    def _add(self, kind, inputs, output, **attributes):
        self._nodes.append(helper.make_node(kind, inputs, [output], **attributes))
        return output

    def _initializer(self, name, array):
        if name not in self._weights:
            self._weights[name] = numpy_helper.from_array(array, name)
        return name

    def _drop_unread(self):
        read = {name for node in self._nodes for name in node.input}
        del self._graph.initializer[:]
        self._graph.initializer.extend(x for name, x in self._weights.items() if name in read)


def to_int8(weights, axis):
    """round(x / scale) with scale = max |x| / 127 along `axis` (None: of all); the scales without
    that axis."""
    largest = np.abs(weights).max(axis=axis, keepdims=axis is not None)
    scale = np.asarray(np.where(largest == 0, 1, largest / np.float32(127)), np.float32)
    values = np.rint(weights / scale).clip(-127, 127).astype(np.int8)
    return values, scale if axis is None else scale.squeeze(axis)
