// Declaring ops: every method checks the shapes it is given and appends one node.
#include <algorithm>
#include <cmath>

#include "engine/graph.h"
#include "engine/graph_shapes.h"

namespace gestus {
namespace {

bool BiasFits(const TensorView& bias, std::int64_t n) {
  return bias.data == nullptr || (bias.shape == Shape{n} && bias.dtype == DType::kF32);
}

bool IsProductType(DType dtype) {
  return dtype == DType::kF32 || dtype == DType::kBF16 || dtype == DType::kI8;
}

}  // namespace

const char* Name(Op op) {
  switch (op) {
    case Op::kLinear:
      return "linear";
    case Op::kAttention:
      return "attention";
    case Op::kLstm:
      return "lstm";
    case Op::kLayerNorm:
      return "layer_norm";
    case Op::kSoftmax:
      return "softmax";
    case Op::kActivate:
      return "activate";
    case Op::kAdd:
      return "add";
    case Op::kAffine:
      return "affine";
    case Op::kConcat:
      return "concat";
    case Op::kConcatRows:
      return "concat_rows";
    case Op::kRepeatRows:
      return "repeat_rows";
    case Op::kMeanRows:
      return "mean_rows";
    case Op::kGather:
      return "gather";
    case Op::kPatches:
      return "patches";
    case Op::kPadRows:
      return "pad_rows";
    case Op::kStoreRows:
      return "store_rows";
    case Op::kLastRows:
      return "last_rows";
    case Op::kStepRow:
      return "step_row";
    case Op::kPreviousRow:
      return "previous_row";
    case Op::kPick:
      return "pick";
  }
  return "unknown";
}

std::string NameWithType(const Node& node) {
  const bool plain = node.weight.data == nullptr || node.weight.dtype == DType::kF32;
  if (node.narrow) return std::string(Name(node.op)) + "(bf16)";
  return std::string(Name(node.op)) +
         (plain ? "" : std::string("(") + Name(node.weight.dtype) + ")");
}

Value Graph::Linear(Value x, const LinearWeights& w, Activation act, float alpha) {
  if (Bad(x)) return {};
  if (!Expect(w.weight.shape.rank() == 2 && shape(x).Cols() == w.weight.shape[1],
              "linear: input is " + shape(x).ToString() + " and weight " +
                  w.weight.shape.ToString() +
                  ", expected (out, in) with in = columns of the input") ||
      !Expect(BiasFits(w.bias, w.weight.shape[0]), "linear: bias " + w.bias.shape.ToString() +
                                                       " for weight " + w.weight.shape.ToString()))
    return {};
  Node node = NewNode(Op::kLinear, {x.id});
  node.weight = w.weight;
  node.bias = w.bias;
  node.act = act;
  node.alpha = alpha;
  return Emit(std::move(node), WithCols(shape(x), w.weight.shape[0]));
}

bool Graph::IsNarrowProduct(Value x) const {
  const int base = info(x).base >= 0 ? info(x).base : x.id;
  for (const Node& node : nodes_) {
    if (node.output == base) return node.op == Op::kLinear && node.weight.dtype != DType::kF32;
  }
  return false;
}

Value Graph::Attention(Value q, Value k, Value v, const AttentionOptions& o) {
  if (Bad(q) || Bad(k) || Bad(v)) return {};
  const Shape &sq = shape(q), &sk = shape(k), &sv = shape(v);
  if (!Expect(o.heads > 0 && sq.rank() >= 2 && sk.rank() >= 2 && sv.rank() >= 2 &&
                  sq.Cols() == sk.Cols() && RowsOf(sk) == RowsOf(sv) &&
                  BatchOf(sq) == BatchOf(sk) && BatchOf(sk) == BatchOf(sv),
              "attention: q " + sq.ToString() + ", k " + sk.ToString() + ", v " + sv.ToString() +
                  " do not fit each other") ||
      !Expect(sq.Cols() % o.heads == 0 && sv.Cols() % o.heads == 0,
              "attention: " + std::to_string(o.heads) + " heads do not divide the widths " +
                  std::to_string(sq.Cols()) + " and " + std::to_string(sv.Cols())) ||
      !Expect(o.key_bias.id < 0 || shape(o.key_bias).NumElements() == RowsOf(sk),
              "attention: key mask does not have one value for each key") ||
      !Expect(!o.by_step || (loop_ >= 0 && RowsOf(sq) == 1 &&
                             RowsOf(sk) >= loops_[static_cast<std::size_t>(loop_)].count),
              "attention: by_step needs a loop, one query row and a key for each step"))
    return {};
  Node node = NewNode(Op::kAttention, {q.id, k.id, v.id});
  if (o.key_bias.id >= 0) node.inputs.push_back(o.key_bias.id);
  node.heads = o.heads;
  node.causal = o.causal;
  node.by_step = o.by_step;
  node.narrow = IsNarrowProduct(q) && IsNarrowProduct(k) && IsNarrowProduct(v);
  node.scale = o.scale != 0.0f
                   ? o.scale
                   : 1.0f / std::sqrt(static_cast<float>(sq.Cols()) / static_cast<float>(o.heads));
  return Emit(std::move(node), WithCols(sq, sv.Cols()));
}

Value Graph::Lstm(Value x, const LstmWeights& w, bool reverse) {
  if (Bad(x)) return {};
  const Shape& hh = w.w_hh.shape;
  if (!Expect(hh.rank() == 2 && hh[0] == 4 * hh[1] && w.w_ih.shape.rank() == 2 &&
                  w.w_ih.shape[0] == hh[0] && BiasFits(w.b_ih, hh[0]) && BiasFits(w.b_hh, hh[0]),
              "lstm: weights " + w.w_ih.shape.ToString() + " and " + hh.ToString() +
                  ", expected (4H, in) and (4H, H), biases (4H,)"))
    return {};
  const auto gates = static_cast<std::size_t>(hh[0]);
  float* bias = Own(gates);
  if (bias == nullptr) return {};
  for (const TensorView* b : {&w.b_ih, &w.b_hh}) {
    if (b->data == nullptr) continue;
    for (std::size_t i = 0; i < gates; ++i) bias[i] += b->f32()[i];
  }
  const Value proj = Linear(x, {w.w_ih, {DType::kF32, {hh[0]}, bias}});
  if (Bad(proj)) return {};
  Node node = NewNode(Op::kLstm, {proj.id});
  node.weight = w.w_hh;
  node.layout = PackLayout::kRecurrent;
  node.reverse = reverse;
  return Emit(std::move(node), WithCols(shape(x), hh[1]));
}

Value Graph::Conv1d(Value x, const LinearWeights& w, std::int64_t stride, std::int64_t pad_before,
                    std::int64_t pad_after, Activation act) {
  if (Bad(x)) return {};
  const Shape sx = shape(x), &sw = w.weight.shape;
  const std::int64_t rows = RowsOf(sx) + pad_before + pad_after;
  if (!Expect(sw.rank() == 3 && sw[1] == sx.Cols() && stride > 0 && pad_before >= 0 &&
                  pad_after >= 0 && rows >= sw[2] && BiasFits(w.bias, sw[0]),
              "conv1d: input " + sx.ToString() + " and weight " + sw.ToString() +
                  ", expected (C_out, C_in, k) with C_in = columns of the input and k at most the "
                  "padded rows, and a bias (C_out,)"))
    return {};
  Node pad = NewNode(Op::kPadRows, {x.id});
  pad.before = pad_before;
  const Value padded = Emit(std::move(pad), WithRows(sx, rows));
  // Row t' of the window view is rows t' * stride to t' * stride + k - 1 of the padded sequence.
  const std::int64_t windows = (rows - sw[2]) / stride + 1;
  const Value view = View(padded, WithCols(WithRows(sx, windows), sw[2] * sw[1]), 0,
                          stride * sx.Cols(), rows * sx.Cols());
  Node node = NewNode(Op::kLinear, {view.id});
  node.weight = w.weight;
  node.bias = w.bias;
  node.layout = PackLayout::kConv1d;
  node.act = act;
  return Emit(std::move(node), WithCols(shape(view), sw[0]));
}

Value Graph::Patches(Value x, const PatchOptions& o) {
  if (Bad(x)) return {};
  const Shape& s = shape(x);
  if (!Expect(s.rank() == 2 && o.patch > 0 && o.stride > 0 && s[0] >= o.patch && s[1] >= o.patch,
              "patches: input " + s.ToString() + " is smaller than a patch of edge " +
                  std::to_string(o.patch)))
    return {};
  Node node = NewNode(Op::kPatches, {x.id});
  node.patches = o;
  const std::int64_t along_t = (s[0] - o.patch) / o.stride + 1;
  const std::int64_t along_f = (s[1] - o.patch) / o.stride + 1;
  return Emit(std::move(node), {along_f * along_t, o.patch * o.patch});
}

Value Graph::LayerNorm(Value x, const NormWeights& w) {
  if (Bad(x)) return {};
  if (!Expect(w.gamma.shape.NumElements() == shape(x).Cols() && w.gamma.shape == w.beta.shape &&
                  w.gamma.dtype == DType::kF32 && w.beta.dtype == DType::kF32,
              "layer_norm: input " + shape(x).ToString() + ", weight " + w.gamma.shape.ToString()))
    return {};
  Node node = NewNode(Op::kLayerNorm, {x.id});
  node.weight = w.gamma;
  node.bias = w.beta;
  node.eps = w.eps;
  return Emit(std::move(node), shape(x));
}

Value Graph::Softmax(Value x) {
  if (Bad(x)) return {};
  return Emit(NewNode(Op::kSoftmax, {x.id}), shape(x));
}

Value Graph::Activate(Value x, Activation act, float alpha) {
  if (Bad(x)) return {};
  Node node = NewNode(Op::kActivate, {x.id});
  node.act = act;
  node.alpha = alpha;
  return Emit(std::move(node), shape(x));
}

Value Graph::Add(Value a, Value b) {
  if (Bad(a) || Bad(b)) return {};
  const Shape sa = shape(a), sb = shape(b);
  if (!Expect(sa == sb || (sb.Rows() == 1 && sb.Cols() == sa.Cols()),
              "add: " + sa.ToString() + " and " + sb.ToString() + " do not fit each other"))
    return {};
  return Emit(NewNode(Op::kAdd, {a.id, b.id}), sa);
}

Value Graph::Affine(Value x, const std::vector<float>& scale, const std::vector<float>& shift) {
  if (Bad(x)) return {};
  const std::int64_t cols = shape(x).Cols();
  const auto n = static_cast<std::size_t>(cols);
  if (!Expect(scale.size() == n && shift.size() == n,
              "affine: " + std::to_string(scale.size()) + " factors for " + shape(x).ToString()))
    return {};
  float* owned = Own(2 * n);
  if (owned == nullptr) return {};
  std::copy(scale.begin(), scale.end(), owned);
  std::copy(shift.begin(), shift.end(), owned + n);
  Node node = NewNode(Op::kAffine, {x.id});
  node.weight = {DType::kF32, {cols}, owned};
  node.bias = {DType::kF32, {cols}, owned + n};
  return Emit(std::move(node), shape(x));
}

Value Graph::Concat(const std::vector<Value>& parts) {
  std::int64_t cols = 0;
  Node node = NewNode(Op::kConcat, {});
  for (Value p : parts) {
    if (Bad(p)) return {};
    if (!Expect(WithCols(shape(p), 1) == WithCols(shape(parts[0]), 1),
                "concat: " + shape(p).ToString() + " and " + shape(parts[0]).ToString() +
                    " differ in rows"))
      return {};
    node.inputs.push_back(p.id);
    cols += shape(p).Cols();
  }
  if (!Expect(!parts.empty(), "concat: nothing to put together")) return {};
  return Emit(std::move(node), WithCols(shape(parts[0]), cols));
}

Value Graph::ConcatRows(const std::vector<Value>& parts) {
  std::int64_t rows = 0;
  Node node = NewNode(Op::kConcatRows, {});
  for (Value p : parts) {
    if (Bad(p)) return {};
    if (!Expect(BatchOf(shape(p)) == 1 && shape(p).Cols() == shape(parts[0]).Cols(),
                "concat_rows: " + shape(p).ToString() + " and " + shape(parts[0]).ToString() +
                    " differ in columns"))
      return {};
    node.inputs.push_back(p.id);
    rows += RowsOf(shape(p));
  }
  if (!Expect(!parts.empty(), "concat_rows: nothing to put together")) return {};
  return Emit(std::move(node), {rows, shape(parts[0]).Cols()});
}

Value Graph::RepeatRows(Value row, std::int64_t count) {
  if (Bad(row)) return {};
  if (!Expect(shape(row).Rows() == 1 && count > 0,
              "repeat_rows: input " + shape(row).ToString() + ", expected one row"))
    return {};
  if (count == 1) return row;
  return Emit(NewNode(Op::kRepeatRows, {row.id}), {count, shape(row).Cols()});
}

Value Graph::MeanRows(Value x) {
  if (Bad(x)) return {};
  if (!Expect(BatchOf(shape(x)) == 1, "mean_rows: expected a matrix")) return {};
  return Emit(NewNode(Op::kMeanRows, {x.id}), {1, shape(x).Cols()});
}

Value Graph::Embedding(Value ids, const TensorView& table, float scale) {
  if (Bad(ids)) return {};
  if (!Expect(
          info(ids).dtype == DType::kI32 && table.shape.rank() == 2 && IsProductType(table.dtype),
          "embedding: expected int32 ids and a table (V, D)"))
    return {};
  Node node = NewNode(Op::kGather, {ids.id});
  node.weight = table;
  node.scale = scale;
  return Emit(std::move(node), {shape(ids).NumElements(), table.shape[1]});
}

bool Graph::HoldsSteps(const char* op, Value buffer) {
  return Expect(loop_ >= 0 && info(buffer).buffer && BatchOf(shape(buffer)) == 1 &&
                    shape(buffer).Rows() >= loops_[static_cast<std::size_t>(loop_)].count,
                std::string(op) + ": expected a buffer with a row for each step of the loop");
}

void Graph::StoreRows(Value buffer, Value rows) {
  if (Bad(buffer) || Bad(rows) || !HoldsSteps("store_rows", buffer)) return;
  if (!Expect(BatchOf(shape(rows)) == 1 && shape(rows).Cols() == shape(buffer).Cols(),
              "store_rows: " + shape(rows).ToString() + " into " + shape(buffer).ToString()))
    return;
  Node node = NewNode(Op::kStoreRows, {rows.id});
  node.output = buffer.id;
  Emit(std::move(node), shape(buffer), info(buffer).dtype);
}

Value Graph::LastRows(Value buffer, std::int64_t count) {
  if (Bad(buffer) || !HoldsSteps("last_rows", buffer)) return {};
  if (!Expect(count > 0, "last_rows: expected one row or more")) return {};
  return Emit(NewNode(Op::kLastRows, {buffer.id}), {count, shape(buffer).Cols()},
              info(buffer).dtype);
}

Value Graph::StepRow(Value x) {
  if (Bad(x)) return {};
  if (!Expect(loop_ >= 0 && BatchOf(shape(x)) == 1 &&
                  shape(x).Rows() >= loops_[static_cast<std::size_t>(loop_)].count,
              "step_row: " + shape(x).ToString() + " has fewer rows than the loop has steps"))
    return {};
  return Emit(NewNode(Op::kStepRow, {x.id}), {1, shape(x).Cols()});
}

Value Graph::PreviousRow(Value buffer, Value first) {
  if (Bad(buffer) || !HoldsSteps("previous_row", buffer)) return {};
  Node node = NewNode(Op::kPreviousRow, {buffer.id});
  const std::int64_t cols = shape(buffer).Cols();
  if (first.id >= 0) {
    if (Bad(first) || !Expect(shape(first).NumElements() == cols,
                              "previous_row: first row " + shape(first).ToString() + " for " +
                                  shape(buffer).ToString()))
      return {};
    node.inputs.push_back(first.id);
  }
  return Emit(std::move(node), {1, cols}, info(buffer).dtype);
}

Value Graph::Pick(Value logits, Value controls, Value u) {
  if (Bad(logits) || Bad(controls) || Bad(u)) return {};
  if (!Expect(shape(logits).Rows() == 1 && shape(controls) == Shape{1, 2} &&
                  shape(u).NumElements() == 1,
              "pick: logits " + shape(logits).ToString() + ", controls " +
                  shape(controls).ToString() + ", u " + shape(u).ToString() +
                  ", expected (1, V), (1, 2) and (1, 1)"))
    return {};
  return Emit(NewNode(Op::kPick, {logits.id, controls.id, u.id}), {1, 1}, DType::kI32);
}

}  // namespace gestus
