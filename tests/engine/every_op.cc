// The model of every op.
#include "tests/engine/every_op.h"

#include <cmath>

namespace gestus::test {
namespace {

constexpr std::int64_t kRows = 12, kMel = 20, kWidth = 24, kSteps = 6, kPose = 8;

class Weights {
 public:
  Weights(Tensors& tensors, DType dtype) : tensors_(tensors), dtype_(dtype) {}
  LinearWeights Linear(std::int64_t out, std::int64_t in) {
    const float scale = 1.0f / std::sqrt(static_cast<float>(in));
    return {Matrix({out, in}, scale), tensors_.Make({out}, ++seed_, 0.1f)};
  }
  LinearWeights Conv(std::int64_t out, std::int64_t in, std::int64_t k) {
    return {Matrix({out, in, k}, 0.2f), tensors_.Make({out}, ++seed_, 0.1f)};
  }
  LstmWeights Lstm(std::int64_t hidden, std::int64_t in) {
    return {Matrix({4 * hidden, in}, 0.3f), Matrix({4 * hidden, hidden}, 0.05f),
            tensors_.Make({4 * hidden}, ++seed_), tensors_.Make({4 * hidden}, ++seed_)};
  }
  NormWeights Norm(std::int64_t d) {
    return {tensors_.Make({d}, ++seed_), tensors_.Make({d}, ++seed_)};
  }
  TensorView Of(Shape shape, std::vector<float> values) {
    return tensors_.Of(shape, std::move(values));
  }
  TensorView Values(Shape shape) { return tensors_.Make(shape, ++seed_); }
  TensorView Table(Shape shape) { return Matrix(shape, 1.0f); }

 private:
  TensorView Matrix(Shape shape, float scale) {
    return tensors_.As(dtype_, tensors_.Make(shape, ++seed_, scale));
  }

  Tensors& tensors_;
  DType dtype_;
  std::uint32_t seed_ = 100;
};

Value Layers(Graph& g, Weights& w, Value x, Value ids) {
  const Graph::Scope scope(g, "layers");
  const Value patches = g.Linear(g.Patches(x, {4, 4}), w.Linear(kWidth, 16));  // (15, 24)
  const Value mean = g.RepeatRows(g.MeanRows(patches), kRows);                 // (12, 24)
  const Value words = g.Embedding(ids, w.Table({5, kWidth}), 2.0f);            // (12, 24)
  const Value conv = g.Conv1d(x, w.Conv(kWidth, kMel, 3), 1, 1, 1, Activation::kTanh);
  const Value scaled = g.Affine(x, std::vector<float>(kMel, 0.5f), std::vector<float>(kMel, 1.0f));
  const Value forward = g.Lstm(scaled, w.Lstm(kWidth / 2, kMel));
  const Value backward = g.Lstm(scaled, w.Lstm(kWidth / 2, kMel), true);
  // Wide enough for the threads to divide a step among them.
  const Value wide = g.Linear(g.Lstm(scaled, w.Lstm(256, kMel)), w.Linear(kWidth, 256));
  const Value both = g.Concat({forward, backward});  // (12, 24)
  Value y = g.Add(g.Add(g.Add(mean, words), g.Add(conv, both)), wide);
  y = g.Add(y, g.Positions(kRows, kWidth));
  y = g.LayerNorm(y, w.Norm(kWidth));
  g.Tap("norm", y);
  const Value qkv = g.Linear(y, w.Linear(3 * kWidth, kWidth));
  const Value att = g.Attention(g.Columns(qkv, 0, kWidth), g.Columns(qkv, kWidth, kWidth),
                                g.Columns(qkv, 2 * kWidth, kWidth), {.heads = 3, .causal = true});
  y = g.Add(y, g.Linear(att, w.Linear(kWidth, kWidth)));
  const Value hidden = g.Linear(y, w.Linear(kWidth * 2, kWidth), Activation::kGeluErf);
  y = g.Add(y, g.Activate(g.Linear(hidden, w.Linear(kWidth, kWidth * 2)), Activation::kSigmoid));
  y = g.ConcatRows({g.Rows(y, 6, 6), g.Softmax(g.Rows(y, 0, 6))});
  return g.Reshape(y, {kRows, kWidth});
}

Value Steps(Graph& g, Weights& w, Value memory) {
  const Graph::Scope scope(g, "steps");
  const Value kv = g.Linear(memory, w.Linear(2 * kPose, kWidth));  // (12, 16)
  const Value poses = g.Buffer({kSteps, kPose}), cache = g.Buffer({kSteps, 2 * kPose});
  static const std::int32_t kFirst[] = {1};
  const Value tokens = g.Buffer({kSteps, 1}, DType::kI32);
  const Value first = g.Constant({DType::kI32, {1, 1}, kFirst});
  const TensorView table = w.Table({kPose, kPose});
  const Value controls = g.Constant(w.Of({1, 2}, {0.8f, 4.0f}));  // temperature, top-k
  const Value uniforms = g.Constant(w.Values({kSteps, 1}));
  const Value time = g.Positions(kSteps, kPose);
  g.BeginLoop(kSteps);
  Value x = g.Add(g.Linear(g.PreviousRow(poses), w.Linear(kPose, kPose)), g.StepRow(time));
  x = g.Add(x, g.Embedding(g.PreviousRow(tokens, first), table));
  const Value qkv = g.Linear(x, w.Linear(3 * kPose, kPose));
  g.StoreRows(cache, g.Columns(qkv, kPose, 2 * kPose));
  const Value self = g.Attention(g.Columns(qkv, 0, kPose), g.Columns(cache, 0, kPose),
                                 g.Columns(cache, kPose, kPose), {.heads = 2, .by_step = true});
  x = g.LayerNorm(g.Add(x, self), w.Norm(kPose));
  const Value cross = g.Attention(x, g.Columns(kv, 0, kPose), g.Columns(kv, kPose, kPose),
                                  {.heads = 4, .scale = 0.7f});
  g.StoreRows(poses,
              g.Linear(g.Add(x, cross), w.Linear(kPose, kPose), Activation::kLeakyRelu, 0.1f));
  const Value logits = g.Conv1d(g.LastRows(poses, 3), w.Conv(kPose, kPose, 3), 1, 0, 0);
  g.StoreRows(tokens, g.Pick(logits, controls, g.StepRow(uniforms)));
  g.EndLoop();
  return poses;
}

}  // namespace

Graph EveryOp(Tensors& tensors, DType weights) {
  Weights w(tensors, weights);
  Graph g;
  const Value x = g.Input("x", {kRows, kMel});
  const Value ids = g.Input("ids", {kRows}, DType::kI32);
  const Value rows = Layers(g, w, x, ids);
  g.Output("rows", rows);
  g.Output("steps", Steps(g, w, rows));
  return g;
}

void FillEveryOp(const Session& session, std::uint32_t seed) {
  const std::vector<float> x = Noise(kRows * kMel, seed);
  std::copy(x.begin(), x.end(), session.Input("x").f32);
  for (std::int32_t i = 0; i < kRows; ++i) session.Input("ids").i32[i] = i % 5;
}

Model MakeEveryOp(const kernels::KernelTable& kernels, const PlanOptions& options, DType weights) {
  Model model;
  model.tensors = std::make_unique<Tensors>();
  WeightCache cache(kernels, nullptr);
  auto plan = Plan::Make(EveryOp(*model.tensors, weights), cache, options);
  if (plan.ok()) model.plan = *plan;
  return model;
}

std::vector<float> AllOutputs(const Session& session) {
  std::vector<float> all;
  for (const NamedValue& out : session.plan().outputs()) {
    const ValueView view = session.Output(out.name);
    for (std::int64_t r = 0; r < view.shape.Rows(); ++r)
      all.insert(all.end(), view.f32 + r * view.row_stride,
                 view.f32 + r * view.row_stride + view.shape.Cols());
  }
  return all;
}

}  // namespace gestus::test
