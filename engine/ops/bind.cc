// The one place that knows every op: its family, its scratch, its work.
#include "engine/ops/bind.h"

namespace gestus {
namespace {

const Shape& ShapeOf(int id, const std::vector<ValueInfo>& values) {
  return values[static_cast<std::size_t>(id)].shape;
}

double Elements(int id, const std::vector<ValueInfo>& values) {
  return static_cast<double>(ShapeOf(id, values).NumElements());
}

}  // namespace

bool NeedsPacking(const Node& node) { return node.op == Op::kLinear || node.op == Op::kLstm; }

std::size_t PartScratch(const Node& node, const std::vector<ValueInfo>& values,
                          const kernels::KernelTable& kernels) {
  if (node.op == Op::kAttention) return AttentionScratch(node, values, kernels);
  const kernels::ProductKernels* products = ProductsOf(kernels, node.weight.dtype);
  if (products == nullptr || !NeedsPacking(node)) return 0;
  const auto rows =
      static_cast<std::size_t>(node.op == Op::kLstm ? 1 : ShapeOf(node.output, values).Rows());
  const auto n = static_cast<std::size_t>(node.weight.shape[0]);
  const auto k = static_cast<std::size_t>(node.weight.shape.NumElements()) / n;
  return (products->scratch(rows, k) + sizeof(float) - 1) / sizeof(float);
}

std::size_t SharedScratch(const Node& node, const std::vector<ValueInfo>& values) {
  switch (node.op) {
    case Op::kLstm:  // the cell state, and the hidden state before the first step
      return 2 * static_cast<std::size_t>(ShapeOf(node.output, values).Cols());
    case Op::kPick:  // the logits, to be ordered
      return static_cast<std::size_t>(ShapeOf(node.inputs[0], values).Cols());
    default:
      return 0;
  }
}

OpCost CostOf(const Node& node, const std::vector<ValueInfo>& values) {
  const double out = Elements(node.output, values);
  const double weights = node.weight.data != nullptr && node.op != Op::kGather
                             ? static_cast<double>(node.weight.shape.NumElements())
                             : 0;
  OpCost cost;
  cost.bytes = 4 * out + static_cast<double>(SizeOf(node.weight.dtype)) * weights;
  for (int in : node.inputs) cost.bytes += 4 * Elements(in, values);
  switch (node.op) {
    case Op::kLinear: {
      const double k = weights / static_cast<double>(node.weight.shape[0]);
      cost.flops = 2 * out * k;
      break;
    }
    case Op::kLstm:
      cost.flops = 2 * out * static_cast<double>(node.weight.shape[0]);
      break;
    case Op::kAttention: {
      // Scores and weighted sum; a causal row sees half of the keys on average.
      const Shape& k = ShapeOf(node.inputs[1], values);
      const double keys = static_cast<double>(k[k.rank() - 2]);
      const double q = Elements(node.inputs[0], values);
      cost.flops = 2 * (q + out) * keys * (node.causal || node.by_step ? 0.5 : 1.0);
      break;
    }
    default:
      cost.flops = out;
  }
  return cost;
}

std::unique_ptr<BoundOp> Bind(const Binding& b) {
  switch (b.node->op) {
    case Op::kLinear:
      return BindLinear(b);
    case Op::kAttention:
      return BindAttention(b);
    case Op::kLstm:
      return BindLstm(b);
    case Op::kLayerNorm:
    case Op::kSoftmax:
    case Op::kActivate:
    case Op::kAdd:
    case Op::kAffine:
      return BindRowwise(b);
    case Op::kConcat:
    case Op::kConcatRows:
    case Op::kRepeatRows:
    case Op::kMeanRows:
    case Op::kGather:
    case Op::kPatches:
    case Op::kPadRows:
    case Op::kStoreRows:
    case Op::kLastRows:
    case Op::kStepRow:
    case Op::kPreviousRow:
      return BindMove(b);
    case Op::kPick:
      return BindPick(b);
  }
  return nullptr;
}

}  // namespace gestus
