// A network, declared once as ops on named values.
//
//   Graph g;
//   Value x = g.Input("speech", {64, 128});
//   Value y = g.LayerNorm(g.Add(x, g.Linear(x, w.proj)), w.norm);
//   g.Output("pose", y);
//
// Values are matrices (T, D), or stacks of them (B, T, D), in float32.  Each call checks the shapes
// it is given; the first mistake is kept in status() and makes every later call a no-op, so that a
// declaration reads without error handling.  What can be fused is the planner's business (plan.h).
#ifndef GESTUS_ENGINE_GRAPH_H_
#define GESTUS_ENGINE_GRAPH_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/aligned_buffer.h"
#include "engine/status.h"
#include "engine/tensor.h"
#include "engine/weight_cache.h"
#include "kernels/kernels.h"

namespace gestus {

using kernels::Activation;

/// Handle of a value in the graph that made it.
struct Value {
  int id = -1;
};

struct LinearWeights {
  TensorView weight;  ///< (out, in)
  TensorView bias;    ///< (out,), or no data
};
struct NormWeights {
  TensorView gamma, beta;  ///< (D,)
  float eps = 1e-5f;
};
struct LstmWeights {
  TensorView w_ih;        ///< (4H, in); gates i, f, g, o
  TensorView w_hh;        ///< (4H, H)
  TensorView b_ih, b_hh;  ///< (4H,); either may have no data
};

struct AttentionOptions {
  int heads = 1;
  float scale = 0.0f;    ///< factor of the scores; 0: 1 / sqrt(head width)
  bool causal = false;   ///< query i sees keys up to i
  Value key_bias{};      ///< (Tk), 0 where a key counts and -inf where it does not; optional
  bool by_step = false;  ///< inside a loop: keys 0 .. step of the buffers k and v
};

struct PatchOptions {
  std::int64_t patch = 16;   ///< edge
  std::int64_t stride = 10;  ///< distance between patches
};

enum class Op : std::uint8_t {
  kLinear,
  kAttention,
  kLstm,
  kLayerNorm,
  kSoftmax,
  kActivate,
  kAdd,
  kAffine,
  kConcat,
  kConcatRows,
  kRepeatRows,
  kMeanRows,
  kGather,
  kPatches,
  kPadRows,
  kStoreRows,
  kLastRows,
  kStepRow,
  kPreviousRow,
  kPick,
};
const char* Name(Op op);

/// One op with everything that is fixed when the graph is declared.
struct Node {
  Op op;
  std::vector<int> inputs;  ///< value ids; kLinear: x[, residual]; kAttention: q, k, v[, key bias]
  int output = -1;          ///< kStoreRows: the buffer, which it changes in place
  std::string scope;        ///< where in the network, "content/ast/block.3"
  int loop = -1;            ///< index of the enclosing loop

  TensorView weight, bias;  ///< kLinear, kLstm (weight), kLayerNorm and kAffine (gamma, beta)
  PackLayout layout = PackLayout::kLinear;
  Activation act = Activation::kNone;
  bool residual = false;  ///< kLinear: the last input is added after the activation
  float alpha = 0, eps = 0, scale = 1;
  int heads = 1;
  bool causal = false, by_step = false, reverse = false;
  bool narrow = false;      ///< kAttention: in bf16 where the machine multiplies that
  std::int64_t before = 0;  ///< kPadRows: zero rows put before each sequence
  PatchOptions patches;
};
/// "linear", and "linear(int8)" where weights have a type of their own; "attention(bf16)".
std::string NameWithType(const Node& node);

/// A value: its own storage, or a view of another value's.
struct ValueInfo {
  DType dtype = DType::kF32;
  Shape shape;
  int base = -1;              ///< the value whose storage this one shares, or -1
  std::ptrdiff_t offset = 0;  ///< elements from the start of the base
  std::ptrdiff_t row_stride = 0, batch_stride = 0;
  const void* constant = nullptr;  ///< data that lives outside the arena
  bool input = false;
  bool buffer = false;  ///< filled row by row inside a loop
};

struct Loop {
  std::size_t begin = 0, end = 0;  ///< node range
  std::int64_t count = 0;
};

struct NamedValue {
  std::string name;
  int id;
};

class Graph {
 public:
  Value Input(const std::string& name, Shape shape, DType dtype = DType::kF32);
  /// `view` must outlive every session of the plan.
  Value Constant(const TensorView& view);
  Value Zeros(Shape shape);
  /// (length, d), interleaved sines and cosines.
  Value Positions(std::int64_t length, std::int64_t d);

  /// act(x W^T + b)
  Value Linear(Value x, const LinearWeights& w, Activation act = Activation::kNone,
               float alpha = 0.0f);
  /// Multi-head attention on projected q (Tq, D), k (Tk, D), v (Tk, Dv); heads side by side.  Where
  /// all three come from weights of fewer than 32 bits, its products are of bf16 on machines that
  /// have them.
  Value Attention(Value q, Value k, Value v, const AttentionOptions& options);
  /// All hidden states (T, H); `reverse` runs from the last row to the first.
  Value Lstm(Value x, const LstmWeights& w, bool reverse = false);
  /// Windows of k rows with zero padding, (T, C_in) -> (T', C_out); weight (C_out, C_in, k).
  Value Conv1d(Value x, const LinearWeights& w, std::int64_t stride, std::int64_t pad_before,
               std::int64_t pad_after, Activation act = Activation::kNone);
  /// Square patches of x (T, F) seen as an image of F rows and T columns, row by row:
  /// (F', T') patches of patch * patch values each.
  Value Patches(Value x, const PatchOptions& options);
  Value LayerNorm(Value x, const NormWeights& w);
  Value Softmax(Value x);
  Value Activate(Value x, Activation act, float alpha = 0.0f);
  /// b may have a single row, which is then added to every row.
  Value Add(Value a, Value b);
  /// x * scale + shift by column.
  Value Affine(Value x, const std::vector<float>& scale, const std::vector<float>& shift);
  Value Concat(const std::vector<Value>& parts);      ///< side by side
  Value ConcatRows(const std::vector<Value>& parts);  ///< one after the other
  Value RepeatRows(Value row, std::int64_t count);    ///< (1, D) -> (count, D)
  Value MeanRows(Value x);                            ///< (T, D) -> (1, D)
  /// scale * table[ids], ids (T,) int32.
  Value Embedding(Value ids, const TensorView& table, float scale = 1.0f);

  // Views, which cost nothing.
  Value Rows(Value x, std::int64_t begin, std::int64_t count);
  Value Columns(Value x, std::int64_t begin, std::int64_t count);
  /// The same elements in another shape; x must be contiguous.
  Value Reshape(Value x, Shape shape);

  // A loop, for autoregressive decoding.  Values made between BeginLoop and EndLoop exist for one
  // step; a Buffer keeps its rows.
  void BeginLoop(std::int64_t count);
  void EndLoop();
  Value Buffer(Shape shape, DType dtype = DType::kF32);
  /// The n rows become rows step - n + 1 to step of the buffer; those before row 0 are dropped.
  void StoreRows(Value buffer, Value rows);
  /// Rows step - count + 1 to step of the buffer, zeros in place of those before row 0.
  Value LastRows(Value buffer, std::int64_t count);
  Value StepRow(Value x);  ///< x[step]
  /// buffer[step - 1]; at step 0 the row `first`, or zeros when there is none.
  Value PreviousRow(Value buffer, Value first = {});
  /// One index of the row `logits`, int32 (1, 1).  controls (1, 2) holds temperature and top-k:
  /// temperature 0 takes the largest logit, the first of equals; otherwise an index is drawn from
  /// softmax(logits / temperature) over the k largest logits (0: over all) with u (1, 1) in [0, 1).
  /// -1 when a logit is NaN or +inf.
  Value Pick(Value logits, Value controls, Value u);

  void Output(const std::string& name, Value x);
  /// Names an intermediate, so that it can be compared with another implementation's.
  void Tap(const std::string& name, Value x);

  /// Names the part of the network that is being declared, for messages, plans and taps.
  class Scope {
   public:
    Scope(Graph& g, const std::string& name);
    ~Scope() { g_.scope_.resize(length_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Graph& g_;
    std::size_t length_;
  };

  const Status& status() const { return status_; }
  /// More ops than any real network has: a configuration that asks for more is refused.
  static constexpr std::size_t kMaxNodes = 1 << 14;
  /// Makes the graph's status an error that is found outside, such as in a configuration.
  void Fail(const std::string& message);
  const Shape& shape(Value x) const;

  // What the planner reads.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<ValueInfo>& values() const { return values_; }
  const std::vector<Loop>& loops() const { return loops_; }
  const std::vector<NamedValue>& inputs() const { return inputs_; }
  const std::vector<NamedValue>& outputs() const { return outputs_; }
  const std::vector<NamedValue>& taps() const { return taps_; }
  const std::vector<std::shared_ptr<AlignedBuffer>>& owned() const { return owned_; }

 private:
  /// True when nothing can be done with x; a handle of no value is an error of its own.
  bool Bad(Value x);
  bool Exists(Value x) const {
    return x.id >= 0 && static_cast<std::size_t>(x.id) < values_.size();
  }
  bool GoodShape(const char* op, const Shape& shape);
  bool HoldsSteps(const char* op, Value buffer);
  /// Whether x, or what it is a view of, comes out of a product with weights of fewer than 32 bits.
  bool IsNarrowProduct(Value x) const;
  const ValueInfo& info(Value x) const { return values_[static_cast<std::size_t>(x.id)]; }
  Value NewValue(Shape shape, DType dtype = DType::kF32);
  Value View(Value x, Shape shape, std::ptrdiff_t offset, std::ptrdiff_t row_stride,
             std::ptrdiff_t batch_stride);
  Node NewNode(Op op, std::vector<int> inputs) const;
  Value Emit(Node node, Shape shape, DType dtype = DType::kF32);
  float* Own(std::size_t floats);
  Value OwnedConstant(float* data, Shape shape);
  bool Expect(bool holds, const std::string& message);

  std::vector<Node> nodes_;
  std::vector<ValueInfo> values_;
  std::vector<Loop> loops_;
  std::vector<NamedValue> inputs_, outputs_, taps_;
  std::vector<std::shared_ptr<AlignedBuffer>> owned_;
  std::string scope_;
  int loop_ = -1;
  Status status_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_GRAPH_H_
