// Every op of graph.h against its formula in double precision, on every instruction set, with and
// without fusion.
#include "engine/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/engine/dense.h"
#include "tests/engine/isa_test.h"
#include "tests/tolerance.h"

namespace gestus::test {
namespace {

/// Largest |v|, at least 1.
double Size(const Dense& d) {
  double size = 1;
  for (double v : d.v) size = std::max(size, std::fabs(v));
  return size;
}

class GraphTest : public IsaTest {
 protected:
  using Declare = std::function<Value(Graph&, Value x)>;

  /// Declares a graph on noise x of `shape`, runs it fused and unfused, and compares.  Each op
  /// rounds sums of at most `terms` terms, whose roundings add up to eps / 2 times the number and
  /// the size of them; slopes of what follows stay below 4.
  void Check(Shape shape, std::size_t terms, const Declare& declare, const Dense& want) {
    for (const bool fuse : {true, false}) {
      Graph g;
      const Value x = g.Input("x", shape);
      g.Output("y", declare(g, x));
      ASSERT_TRUE(g.status().ok()) << g.status().message();
      const auto session = Make(std::move(g), {.fuse = fuse});
      ASSERT_NE(session, nullptr);
      const std::vector<float> noise = Noise(shape.NumElements(), kSeed);
      std::copy(noise.begin(), noise.end(), session->Input("x").f32);
      session->Run();
      Compare(ToDense(session->Output("y")), want, 4 * GemmTolerance(terms, 1, Size(want)));
    }
  }

  static void Compare(const Dense& got, const Dense& want, double tolerance) {
    ASSERT_EQ(got.rows, want.rows);
    ASSERT_EQ(got.cols, want.cols);
    for (std::int64_t r = 0; r < got.rows; ++r) {
      for (std::int64_t c = 0; c < got.cols; ++c)
        ASSERT_NEAR(got.at(r, c), want.at(r, c), tolerance) << "row " << r << ", column " << c;
    }
  }

  /// What Check feeds, (rows, cols).
  static Dense X(std::int64_t rows, std::int64_t cols) {
    Dense d(rows, cols);
    const std::vector<float> noise = Noise(rows * cols, kSeed);
    std::copy(noise.begin(), noise.end(), d.v.begin());
    return d;
  }

  static constexpr std::uint32_t kSeed = 7;
  Tensors tensors_;
};
GESTUS_TEST_ON_EVERY_ISA(GraphTest);

TEST_P(GraphTest, Linear) {
  for (const std::int64_t rows : {1, 2, 7, 40}) {
    const LinearWeights w{tensors_.Make({19, 33}, 1), tensors_.Make({19}, 2)};
    Check(
        {rows, 33}, 33, [&](Graph& g, Value x) { return g.Linear(x, w); },
        LinearOf(X(rows, 33), ToDense(w.weight), ToDense(w.bias)));
    Check(
        {rows, 33}, 33,
        [&](Graph& g, Value x) {
          return g.Linear(x, {w.weight, {}});
        },
        LinearOf(X(rows, 33), ToDense(w.weight), {}));
  }
}

TEST_P(GraphTest, LinearWithEveryActivation) {
  const LinearWeights w{tensors_.Make({19, 33}, 1), tensors_.Make({19}, 2)};
  const Dense plain = LinearOf(X(5, 33), ToDense(w.weight), ToDense(w.bias));
  for (const Activation act : {Activation::kRelu, Activation::kLeakyRelu, Activation::kGeluErf,
                               Activation::kGeluTanh, Activation::kTanh, Activation::kSigmoid}) {
    const Dense want = ActivateOf(plain, act, 0.2);
    Check(
        {5, 33}, 33, [&](Graph& g, Value x) { return g.Linear(x, w, act, 0.2f); }, want);
    Check(
        {5, 33}, 33, [&](Graph& g, Value x) { return g.Activate(g.Linear(x, w), act, 0.2f); },
        want);
  }
}

TEST_P(GraphTest, LinearOnAStackOfMatrices) {
  const LinearWeights w{tensors_.Make({9, 17}, 1), tensors_.Make({9}, 2)};
  Check(
      {3, 4, 17}, 17, [&](Graph& g, Value x) { return g.Linear(x, w); },
      LinearOf(X(12, 17), ToDense(w.weight), ToDense(w.bias)));
}

TEST_P(GraphTest, ResidualsOfAllShapes) {
  const LinearWeights w{tensors_.Make({16, 16}, 1), tensors_.Make({16}, 2)};
  const TensorView row = tensors_.Make({1, 16}, 3);
  for (const Shape shape : {Shape{6, 16}, Shape{1, 16}, Shape{3, 2, 16}, Shape{6, 1, 16}}) {
    const Dense x = X(shape.Rows(), 16), y = LinearOf(x, ToDense(w.weight), ToDense(w.bias));
    Check(
        shape, 17, [&](Graph& g, Value v) { return g.Add(v, g.Linear(v, w)); }, AddOf(x, y));
    Check(
        shape, 17, [&](Graph& g, Value v) { return g.Add(g.Linear(v, w), v); }, AddOf(y, x));
    Check(
        shape, 17, [&](Graph& g, Value v) { return g.Add(g.Linear(v, w), g.Constant(row)); },
        AddOf(y, ToDense(row)));
    Check(
        shape, 17, [&](Graph& g, Value v) { return g.Add(v, g.Linear(v, w, Activation::kRelu)); },
        AddOf(x, ActivateOf(y, Activation::kRelu, 0)));
  }
}

TEST_P(GraphTest, SumOfTwoProductsAndItsActivation) {
  const LinearWeights a{tensors_.Make({16, 16}, 1), {}}, b{tensors_.Make({16, 16}, 2), {}};
  const Dense x = X(6, 16);
  const Dense sum = AddOf(LinearOf(x, ToDense(a.weight), {}), LinearOf(x, ToDense(b.weight), {}));
  Check(
      {6, 16}, 32,
      [&](Graph& g, Value v) {
        return g.Activate(g.Add(g.Linear(v, a), g.Linear(v, b)), Activation::kTanh);
      },
      ActivateOf(sum, Activation::kTanh, 0));
}

TEST_P(GraphTest, LayerNorm) {
  const NormWeights w{tensors_.Make({45}, 1), tensors_.Make({45}, 2), 1e-4f};
  Check(
      {6, 45}, 45, [&](Graph& g, Value x) { return g.LayerNorm(x, w); },
      LayerNormOf(X(6, 45), ToDense(w.gamma), ToDense(w.beta), 1e-4));
}

TEST_P(GraphTest, LayerNormOfConstantRowsIsItsShift) {
  const NormWeights w{tensors_.Make({45}, 1), tensors_.Make({45}, 2), 1e-5f};
  const TensorView ones = tensors_.Of({1, 45}, std::vector<float>(45, 3.0f));
  Check(
      {1, 45}, 45, [&](Graph& g, Value) { return g.LayerNorm(g.Constant(ones), w); },
      ToDense(w.beta));
}

TEST_P(GraphTest, Softmax) {
  Check(
      {5, 23}, 23, [](Graph& g, Value x) { return g.Softmax(x); }, SoftmaxOf(X(5, 23)));
}

TEST_P(GraphTest, SoftmaxOfExtremeRows) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const TensorView rows = tensors_.Of({3, 3}, {1e4f, -1e4f, 1e4f, 2, 2, 2, -kInf, -kInf, -kInf});
  Dense want(3, 3);
  want.v = {0.5, 0, 0.5, 1 / 3., 1 / 3., 1 / 3., 0, 0, 0};
  Check(
      {1, 1}, 3, [&](Graph& g, Value) { return g.Softmax(g.Constant(rows)); }, want);
}

TEST_P(GraphTest, AddAndAffine) {
  const Dense x = X(5, 9);
  const std::vector<float> scale = Noise(9, 1), shift = Noise(9, 2);
  Dense want = x;
  for (std::int64_t r = 0; r < 5; ++r) {
    for (std::int64_t c = 0; c < 9; ++c) {
      const auto i = static_cast<std::size_t>(c);
      want.at(r, c) = 2 * x.at(r, c) * scale[i] + shift[i];
    }
  }
  Check(
      {5, 9}, 3, [&](Graph& g, Value v) { return g.Affine(g.Add(v, v), scale, shift); }, want);
}

TEST_P(GraphTest, Attention) {
  for (const std::int64_t rows : {1, 5, 130, 300}) {
    const LinearWeights w{tensors_.Make({36, 12}, 1), {}};
    const Dense qkv = LinearOf(X(rows, 12), ToDense(w.weight), {});
    for (const bool causal : {false, true}) {
      Check(
          {rows, 12}, 12 + static_cast<std::size_t>(rows),
          [&](Graph& g, Value x) {
            const Value p = g.Linear(x, w);
            return g.Attention(g.Columns(p, 0, 12), g.Columns(p, 12, 12), g.Columns(p, 24, 12),
                               {.heads = 3, .causal = causal});
          },
          AttentionOf(ColumnsOf(qkv, 0, 12), ColumnsOf(qkv, 12, 12), ColumnsOf(qkv, 24, 12),
                      {.heads = 3, .causal = causal}));
    }
  }
}

TEST_P(GraphTest, CrossAttentionWithMaskScaleAndWiderValues) {
  const float kHidden = -std::numeric_limits<float>::infinity();
  const TensorView k = tensors_.Make({7, 8}, 1), v = tensors_.Make({7, 12}, 2);
  const TensorView bias = tensors_.Of({7}, {0, kHidden, 0, 0, kHidden, 0, kHidden});
  AttentionFormula formula{.heads = 2, .scale = 0.8};
  for (int i = 0; i < 7; ++i) formula.key_bias.push_back(bias.f32()[i]);
  Check(
      {5, 8}, 16,
      [&](Graph& g, Value q) {
        return g.Attention(q, g.Constant(k), g.Constant(v),
                           {.heads = 2, .scale = 0.8f, .key_bias = g.Constant(bias)});
      },
      AttentionOf(X(5, 8), ToDense(k), ToDense(v), formula));
}

TEST_P(GraphTest, AttentionOnAStackOfMatrices) {
  const Dense x = X(12, 8);
  std::vector<Dense> want;
  for (std::int64_t b = 0; b < 3; ++b) {
    const Dense one = RowsOf(x, 4 * b, 4);
    want.push_back(AttentionOf(one, one, one, {.heads = 2}));
  }
  Check(
      {3, 4, 8}, 12, [](Graph& g, Value v) { return g.Attention(v, v, v, {.heads = 2}); },
      OneBelowTheOther(want));
}

TEST_P(GraphTest, LstmInBothDirections) {
  for (const std::int64_t hidden : {3, 20, 260}) {
    const float scale = 1.0f / std::sqrt(static_cast<float>(hidden));
    const LstmWeights w{tensors_.Make({4 * hidden, 10}, 1, scale),
                        tensors_.Make({4 * hidden, hidden}, 2, scale),
                        tensors_.Make({4 * hidden}, 3), tensors_.Make({4 * hidden}, 4)};
    const Dense bias = AddOf(ToDense(w.b_ih), ToDense(w.b_hh));
    for (const bool reverse : {false, true}) {
      Check(
          {9, 10}, static_cast<std::size_t>(hidden) + 10,
          [&](Graph& g, Value x) { return g.Lstm(x, w, reverse); },
          LstmOf(X(9, 10), ToDense(w.w_ih), ToDense(w.w_hh), bias, reverse));
    }
  }
}

TEST_P(GraphTest, LstmOnAStackOfSequencesStartsEachAfresh) {
  const LstmWeights w{tensors_.Make({12, 4}, 1), tensors_.Make({12, 3}, 2), {}, {}};
  const Dense x = X(10, 4);
  std::vector<Dense> want;
  for (std::int64_t b = 0; b < 2; ++b)
    want.push_back(
        LstmOf(RowsOf(x, 5 * b, 5), ToDense(w.w_ih), ToDense(w.w_hh), Dense(1, 12), false));
  Check(
      {2, 5, 4}, 8, [&](Graph& g, Value v) { return g.Lstm(v, w); }, OneBelowTheOther(want));
}

TEST_P(GraphTest, Conv1d) {
  struct Case {
    std::int64_t kernel, stride, before, after;
  };
  for (const Case& c : {Case{1, 1, 0, 0}, Case{3, 1, 1, 1}, Case{3, 2, 1, 1}, Case{4, 1, 3, 0},
                        Case{5, 3, 0, 2}, Case{11, 1, 0, 0}, Case{2, 7, 0, 0}}) {
    const TensorView w = tensors_.Make({6, 5, c.kernel}, 1), bias = tensors_.Make({6}, 2);
    Dense flat(6, 5 * c.kernel);
    std::copy_n(w.f32(), flat.v.size(), flat.v.begin());
    Check(
        {11, 5}, static_cast<std::size_t>(5 * c.kernel),
        [&](Graph& g, Value x) {
          return g.Conv1d(x, {w, bias}, c.stride, c.before, c.after, Activation::kRelu);
        },
        ActivateOf(Conv1dOf(X(11, 5), flat, ToDense(bias), c.kernel, c.stride, c.before, c.after),
                   Activation::kRelu, 0));
    const Dense x = X(22, 5);
    Check(
        {2, 11, 5}, static_cast<std::size_t>(5 * c.kernel),
        [&](Graph& g, Value v) {
          return g.Conv1d(v, {w, {}}, c.stride, c.before, c.after);
        },
        OneBelowTheOther(
            {Conv1dOf(RowsOf(x, 0, 11), flat, {}, c.kernel, c.stride, c.before, c.after),
             Conv1dOf(RowsOf(x, 11, 11), flat, {}, c.kernel, c.stride, c.before, c.after)}));
  }
}

TEST_P(GraphTest, Patches) {
  // x (T, F) is an image of F rows and T columns.
  const Dense x = X(9, 12);
  Dense want(4 * 3, 9);
  for (std::int64_t f = 0; f < 4; ++f) {
    for (std::int64_t t = 0; t < 3; ++t) {
      for (std::int64_t i = 0; i < 3; ++i) {
        for (std::int64_t j = 0; j < 3; ++j)
          want.at(f * 3 + t, i * 3 + j) = x.at(t * 3 + j, f * 3 + i);
      }
    }
  }
  Check(
      {9, 12}, 1,
      [](Graph& g, Value v) {
        return g.Patches(v, {3, 3});
      },
      want);
}

TEST_P(GraphTest, Embedding) {
  const TensorView table = tensors_.Make({4, 6}, 1);
  Graph g;
  const Value ids = g.Input("ids", {5}, DType::kI32);
  g.Output("y", g.Embedding(ids, table, 3.0f));
  const auto session = Make(std::move(g));
  ASSERT_NE(session, nullptr);
  const std::vector<std::int32_t> given = {3, 0, -1, 4, 2};  // two of them outside the table
  std::copy(given.begin(), given.end(), session->Input("ids").i32);
  session->Run();
  Dense want(5, 6);
  for (std::int64_t r : {0, 1, 4}) {
    for (std::int64_t c = 0; c < 6; ++c)
      want.at(r, c) = 3.0 * ToDense(table).at(given[static_cast<std::size_t>(r)], c);
  }
  Compare(ToDense(session->Output("y")), want, 3 * kEps);
}

TEST_P(GraphTest, ConcatenationsInsideConcatenations) {
  const LinearWeights a{tensors_.Make({4, 6}, 1), {}}, b{tensors_.Make({7, 6}, 2), {}};
  const Dense x = X(5, 6), ya = LinearOf(x, ToDense(a.weight), {}),
              yb = LinearOf(x, ToDense(b.weight), {});
  Check(
      {5, 6}, 6,
      [&](Graph& g, Value v) {
        const Value inner = g.Concat({g.Linear(v, a), g.Linear(v, b)});
        const Value outer = g.Concat({inner, v, g.Linear(v, b)});
        return g.ConcatRows({outer, g.Concat({v, g.Linear(v, b), g.Linear(v, a), g.Linear(v, b)})});
      },
      OneBelowTheOther({SideBySide({ya, yb, x, yb}), SideBySide({x, yb, ya, yb})}));
}

TEST_P(GraphTest, ConcatOfViewsConstantsAndTwiceTheSame) {
  const LinearWeights a{tensors_.Make({4, 6}, 1), {}};
  const TensorView c = tensors_.Make({5, 3}, 9);
  const Dense x = X(5, 6), y = LinearOf(x, ToDense(a.weight), {});
  Check(
      {5, 6}, 6,
      [&](Graph& g, Value v) {
        const Value l = g.Linear(v, a);
        return g.Concat({l, l, g.Columns(v, 2, 3), g.Constant(c), g.Zeros({5, 2})});
      },
      SideBySide({y, y, ColumnsOf(x, 2, 3), ToDense(c), Dense(5, 2)}));
}

TEST_P(GraphTest, ConcatOfStacks) {
  const LinearWeights a{tensors_.Make({4, 6}, 1), {}};
  const Dense x = X(6, 6);
  Check(
      {2, 3, 6}, 6,
      [&](Graph& g, Value v) {
        return g.Concat({g.Linear(v, a), v});
      },
      SideBySide({LinearOf(x, ToDense(a.weight), {}), x}));
}

TEST_P(GraphTest, ViewsOfViews) {
  const Dense x = X(8, 10);
  Check(
      {8, 10}, 1,
      [](Graph& g, Value v) {
        const Value part = g.Columns(g.Rows(v, 2, 5), 3, 6);
        return g.Concat({g.Rows(part, 1, 3), g.Columns(g.Rows(v, 0, 3), 9, 1)});
      },
      SideBySide({ColumnsOf(RowsOf(x, 3, 3), 3, 6), ColumnsOf(RowsOf(x, 0, 3), 9, 1)}));
  Dense same = x;
  same.rows = 20;
  same.cols = 4;
  Check(
      {8, 10}, 1,
      [](Graph& g, Value v) {
        return g.Reshape(v, {20, 4});
      },
      same);
  Check(
      {8, 10}, 1,
      [](Graph& g, Value v) {
        return g.Reshape(g.Reshape(v, {4, 5, 4}), {20, 4});
      },
      same);
}

TEST_P(GraphTest, RepeatAndMeanOfRows) {
  const Dense x = X(6, 5);
  Dense mean(1, 5);
  for (std::int64_t r = 0; r < 6; ++r) {
    for (std::int64_t c = 0; c < 5; ++c) mean.at(0, c) += x.at(r, c) / 6;
  }
  Check(
      {6, 5}, 6, [](Graph& g, Value v) { return g.RepeatRows(g.MeanRows(v), 3); },
      OneBelowTheOther({mean, mean, mean}));
  Check(
      {6, 5}, 6, [](Graph& g, Value v) { return g.RepeatRows(g.MeanRows(v), 1); }, mean);
}

TEST_P(GraphTest, Positions) {
  Dense want(6, 5);
  for (std::int64_t p = 0; p < 6; ++p) {
    for (std::int64_t i = 0; i < 5; ++i) {
      const double angle =
          static_cast<double>(p) / std::pow(1e4, static_cast<double>(i - i % 2) / 5.0);
      want.at(p, i) = i % 2 == 0 ? std::sin(angle) : std::cos(angle);
    }
  }
  Check(
      {6, 5}, 1, [](Graph& g, Value) { return g.Positions(6, 5); }, want);
}

TEST_P(GraphTest, LoopIsARecurrence) {
  // y_t = tanh(W [y_{t-1}, x_t])
  const LinearWeights w{tensors_.Make({4, 7}, 1, 0.5f), tensors_.Make({4}, 2)};
  const Dense x = X(9, 3);
  Dense want(9, 4), last(1, 4);
  for (std::int64_t t = 0; t < 9; ++t) {
    last = ActivateOf(
        LinearOf(SideBySide({last, RowsOf(x, t, 1)}), ToDense(w.weight), ToDense(w.bias)),
        Activation::kTanh, 0);
    for (std::int64_t c = 0; c < 4; ++c) want.at(t, c) = last.at(0, c);
  }
  Check(
      {9, 3}, 7 * 4,
      [&](Graph& g, Value v) {
        const Value y = g.Buffer({9, 4});
        g.BeginLoop(9);
        g.StoreRows(y, g.Linear(g.Concat({g.PreviousRow(y), g.StepRow(v)}), w, Activation::kTanh));
        g.EndLoop();
        return g.Add(y, g.Zeros({1, 4}));
      },
      want);
}

TEST_P(GraphTest, AttentionByStepIsCausalAttention) {
  const LinearWeights w{tensors_.Make({24, 8}, 1), {}};
  const Dense qkv = LinearOf(X(10, 8), ToDense(w.weight), {});
  Check(
      {10, 8}, 18,
      [&](Graph& g, Value x) {
        const Value cache = g.Buffer({10, 16}), out = g.Buffer({10, 8});
        g.BeginLoop(10);
        const Value row = g.Linear(g.StepRow(x), w);
        g.StoreRows(cache, g.Columns(row, 8, 16));
        g.StoreRows(out, g.Attention(g.Columns(row, 0, 8), g.Columns(cache, 0, 8),
                                     g.Columns(cache, 8, 8), {.heads = 2, .by_step = true}));
        g.EndLoop();
        return out;
      },
      AttentionOf(ColumnsOf(qkv, 0, 8), ColumnsOf(qkv, 8, 8), ColumnsOf(qkv, 16, 8),
                  {.heads = 2, .causal = true}));
}

TEST_P(GraphTest, TwoLoopsOneAfterTheOther) {
  // Running sums of running sums; the first loop's buffer is read by the second.
  const Dense x = X(5, 3);
  Dense want = x;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::int64_t t = 1; t < 5; ++t) {
      for (std::int64_t c = 0; c < 3; ++c) want.at(t, c) += want.at(t - 1, c);
    }
  }
  Check(
      {5, 3}, 15,
      [](Graph& g, Value v) {
        for (int pass = 0; pass < 2; ++pass) {
          const Value sums = g.Buffer({5, 3});
          g.BeginLoop(5);
          g.StoreRows(sums, g.Add(g.PreviousRow(sums), g.StepRow(v)));
          g.EndLoop();
          v = sums;
        }
        return v;
      },
      want);
}

TEST_P(GraphTest, AProductOfABufferSeesItAsItWas) {
  // The product stands before the store that changes its input, its sum stands after.
  const LinearWeights w{tensors_.Make({4, 4}, 1), {}};
  const Dense x = X(1, 4);
  Check(
      {1, 4}, 4,
      [&](Graph& g, Value v) {
        const Value buffer = g.Buffer({1, 4}), sum = g.Buffer({1, 4});
        g.BeginLoop(1);
        g.StoreRows(buffer, v);
        const Value product = g.Linear(buffer, w);
        g.StoreRows(buffer, g.Zeros({1, 4}));
        g.StoreRows(sum, g.Add(v, product));
        g.EndLoop();
        return g.Add(sum, g.Rows(buffer, 0, 1));
      },
      AddOf(x, LinearOf(x, ToDense(w.weight), {})));
}

TEST_P(GraphTest, ConvolutionsOfThePrefixByStep) {
  // Two 'same' convolutions, each step over the rows so far alone: the row before the last one
  // changes when its successor comes, so each layer stores two rows.
  const LinearWeights w1{tensors_.Make({4, 3, 3}, 1, 0.5f), tensors_.Make({4}, 2)};
  const LinearWeights w2{tensors_.Make({5, 4, 3}, 3, 0.5f), tensors_.Make({5}, 4)};
  const auto flat = [](const TensorView& w) {
    return TensorView{w.dtype, {w.shape[0], w.shape[1] * w.shape[2]}, w.data};
  };
  const Dense x = X(7, 3);
  Dense want(7, 5);
  for (std::int64_t t = 0; t < 7; ++t) {
    Dense y = RowsOf(x, 0, t + 1);
    for (const LinearWeights* w : {&w1, &w2})
      y = ActivateOf(Conv1dOf(y, ToDense(flat(w->weight)), ToDense(w->bias), 3, 1, 1, 1),
                     Activation::kRelu, 0);
    for (std::int64_t c = 0; c < 5; ++c) want.at(t, c) = y.at(t, c);
  }
  Check(
      {7, 3}, 24,
      [&](Graph& g, Value v) {
        const Value in = g.Buffer({7, 3}), hidden = g.Buffer({7, 4}), out = g.Buffer({7, 5});
        g.BeginLoop(7);
        g.StoreRows(in, g.StepRow(v));
        g.StoreRows(hidden, g.Conv1d(g.LastRows(in, 3), w1, 1, 0, 1, Activation::kRelu));
        g.StoreRows(out, g.Conv1d(g.LastRows(hidden, 2), w2, 1, 0, 1, Activation::kRelu));
        g.EndLoop();
        return out;
      },
      want);
}

TEST_P(GraphTest, PreviousRowStartsWithAGivenRow) {
  const Dense x = X(4, 2);
  Dense want(4, 2);
  for (std::int64_t t = 0; t < 4; ++t) {
    for (std::int64_t c = 0; c < 2; ++c) want.at(t, c) = t == 0 ? x.at(3, c) : x.at(t - 1, c);
  }
  Check(
      {4, 2}, 1,
      [](Graph& g, Value v) {
        const Value copy = g.Buffer({4, 2}), out = g.Buffer({4, 2});
        g.BeginLoop(4);
        g.StoreRows(out, g.PreviousRow(copy, g.Rows(v, 3, 1)));
        g.StoreRows(copy, g.StepRow(v));
        g.EndLoop();
        return out;
      },
      want);
}

// Picking tokens: a loop that picks from each row of `logits` and embeds the pick before.

class PickTest : public IsaTest {
 protected:
  struct Picked {
    std::vector<std::int32_t> ids;
    Dense embedded;
  };

  Picked Pick(const std::vector<std::vector<float>>& logits, float temperature, float top_k,
              const std::vector<float>& u) {
    const auto steps = static_cast<std::int64_t>(logits.size());
    const auto size = static_cast<std::int64_t>(logits[0].size());
    static const std::int32_t kFirst[] = {1};
    Graph g;
    const Value rows = g.Input("logits", {steps, size}), controls = g.Input("controls", {1, 2});
    const Value uniforms = g.Input("u", {steps, 1});
    const Value first = g.Constant({DType::kI32, {1, 1}, kFirst});
    const Value ids = g.Buffer({steps, 1}, DType::kI32), embedded = g.Buffer({steps, 3});
    g.BeginLoop(steps);
    g.StoreRows(embedded, g.Embedding(g.PreviousRow(ids, first), table_));
    g.StoreRows(ids, g.Pick(g.StepRow(rows), controls, g.StepRow(uniforms)));
    g.EndLoop();
    g.Output("ids", ids);
    g.Output("embedded", embedded);
    EXPECT_TRUE(g.status().ok()) << g.status().message();
    const auto session = Make(std::move(g));
    for (std::size_t t = 0; t < logits.size(); ++t)
      std::copy(logits[t].begin(), logits[t].end(),
                session->Input("logits").f32 + t * logits[t].size());
    session->Input("controls").f32[0] = temperature;
    session->Input("controls").f32[1] = top_k;
    std::copy(u.begin(), u.end(), session->Input("u").f32);
    session->Run();
    const std::int32_t* picked = session->Output("ids").i32;
    return {{picked, picked + steps}, ToDense(session->Output("embedded"))};
  }

  Tensors tensors_;
  TensorView table_ = tensors_.Make({4, 3}, 5);
};
GESTUS_TEST_ON_EVERY_ISA(PickTest);

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

TEST_P(PickTest, GreedyTakesTheFirstOfTheLargest) {
  const Picked p = Pick({{0, 3, 1, 3}, {-1, -2, -1, -5}, {5, 5, 5, 5}, {-kInf, -kInf, 0, -kInf}}, 0,
                        0, {0.9f, 0.9f, 0.9f, 0.9f});
  EXPECT_EQ(p.ids, (std::vector<std::int32_t>{1, 0, 0, 2}));
  for (const auto& [step, id] : {std::pair(0, 1), {1, 1}, {2, 0}, {3, 0}}) {
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(p.embedded.at(step, c), table_.f32()[id * 3 + c]) << "step " << step;
  }
}

TEST_P(PickTest, DrawsByTheCumulativeSoftmax) {
  // softmax of ln 1, ln 2, ln 4, ln 1: 1/8, 2/8, 4/8, 1/8.
  const std::vector<float> row{0.0f, std::log(2.0f), std::log(4.0f), 0.0f};
  const std::vector<float> u{0.0f, 0.12f, 0.13f, 0.37f, 0.38f, 0.87f, 0.88f, 0.9999999f};
  EXPECT_EQ(Pick(std::vector(u.size(), row), 1, 0, u).ids,
            (std::vector<std::int32_t>{0, 0, 1, 1, 2, 2, 3, 3}));
  // Temperature 1/2 squares the odds: 1, 4, 16, 1 of 22.
  EXPECT_EQ(Pick(std::vector(4, row), 0.5f, 0, {0.04f, 0.05f, 0.22f, 0.23f}).ids,
            (std::vector<std::int32_t>{0, 1, 1, 2}));
}

TEST_P(PickTest, TopKKeepsTheLargestAndTheFirstOfEquals) {
  const std::vector<float> row{0.0f, 1.0f, 0.0f, 1.0f};
  const auto all = [&](float k, float u) { return Pick({row}, 1, k, {u}).ids[0]; };
  EXPECT_EQ(all(1, 0.99f), 1);
  EXPECT_EQ(all(2, 0.49f), 1);
  EXPECT_EQ(all(2, 0.51f), 3);
  EXPECT_EQ(all(3, 0.0f), 0);  // of the two zeros the first is kept
  EXPECT_EQ(all(3, 0.5f), 1);  // 1 : e : e
  EXPECT_EQ(all(3, 0.9999f), 3);
  EXPECT_EQ(all(99, 0.9999f), 3);
}

TEST_P(PickTest, GivesMinusOneForWhatIsNotANumber) {
  for (const auto& row : {std::vector<float>{kNaN, kNaN, kNaN, kNaN},
                          {kNaN, 2, kNaN, 1},
                          {0, 1, 2, kNaN},
                          {kInf, kInf, 0, 0}}) {
    for (const float temperature : {0.0f, 1.0f}) {
      EXPECT_EQ(Pick({row}, temperature, 0, {0.5f}).ids[0], -1);
    }
  }
}

TEST_P(PickTest, StaysInRangeWhateverTheControls) {
  for (const auto& row :
       {std::vector<float>{1, 2, 3, 4}, {-kInf, 2, -kInf, 1}, {-kInf, -kInf, -kInf, -kInf}}) {
    for (const float temperature : {0.0f, 1.0f, kNaN, kInf}) {
      for (const float k : {0.0f, 2.0f, kNaN, kInf, -kInf}) {
        for (const float u : {0.0f, 0.5f, kNaN}) {
          const std::int32_t id = Pick({row}, temperature, k, {u}).ids[0];
          EXPECT_TRUE(id >= 0 && id < 4) << id;
        }
      }
    }
  }
}

// Mistakes in a declaration: one sentence that names the scope, and no later op takes offence.

struct Mistake {
  const char* name;
  const char* expect;
  void (*declare)(Graph& g, Value x, const LinearWeights& w);
};

const Mistake kMistakes[] = {
    {"LinearOfOtherWidth", "linear: input is (6, 10) and weight (4, 8)",
     [](Graph& g, Value x, const LinearWeights& w) { g.Linear(x, w); }},
    {"BiasOfOtherLength", "linear: bias (4,) for weight (3, 10)",
     [](Graph& g, Value x, const LinearWeights& w) {
       TensorView weight = w.weight;
       weight.shape = {3, 10};
       g.Linear(x, {weight, w.bias});
     }},
    {"AddOfOtherShape", "add: (6, 10) and (5, 10)",
     [](Graph& g, Value x, const LinearWeights&) { g.Add(x, g.Rows(x, 0, 5)); }},
    {"RowsOutside", "rows: 4 + 3 of (6, 10)",
     [](Graph& g, Value x, const LinearWeights&) { g.Rows(x, 4, 3); }},
    {"ColumnsOutside", "columns: -1 + 3",
     [](Graph& g, Value x, const LinearWeights&) { g.Columns(x, -1, 3); }},
    {"ReshapeOfOtherSize", "reshape: (6, 10) to (7, 9)",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Reshape(x, {7, 9});
     }},
    {"ReshapeOfScatteredRows", "reshape: (6, 5) to (30, 1)",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Reshape(g.Columns(x, 0, 5), {30, 1});
     }},
    {"RankFour", "reshape: shape (1, 1, 6, 10)",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Reshape(x, {1, 1, 6, 10});
     }},
    {"HeadsThatDoNotDivide", "attention: 3 heads",
     [](Graph& g, Value x, const LinearWeights&) { g.Attention(x, x, x, {.heads = 3}); }},
    {"KeysAndValuesDiffer", "attention: q (6, 10), k (6, 10), v (5, 10)",
     [](Graph& g, Value x, const LinearWeights&) { g.Attention(x, x, g.Rows(x, 0, 5), {}); }},
    {"MaskOfOtherLength", "attention: key mask",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Attention(x, x, x, {.key_bias = g.Zeros({5})});
     }},
    {"ByStepOutsideALoop", "attention: by_step",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Attention(g.Rows(x, 0, 1), x, x, {.by_step = true});
     }},
    {"ByStepBeyondTheKeys", "attention: by_step",
     [](Graph& g, Value x, const LinearWeights&) {
       g.BeginLoop(7);
       g.Attention(g.Rows(x, 0, 1), x, x, {.by_step = true});
     }},
    {"LstmWithoutFourGates", "lstm: weights",
     [](Graph& g, Value x, const LinearWeights& w) {
       g.Lstm(x, {w.weight, w.weight, {}, {}});
     }},
    {"KernelLongerThanTheRows", "conv1d: input",
     [](Graph& g, Value x, const LinearWeights& w) {
       TensorView weight = w.weight;
       weight.shape = {1, 10, 7};
       g.Conv1d(x, {weight, {}}, 1, 0, 0);
     }},
    {"PatchLargerThanTheImage", "patches: input (6, 10)",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Patches(x, {7, 1});
     }},
    {"NormOfOtherWidth", "layer_norm: input (6, 10), weight (4,)",
     [](Graph& g, Value x, const LinearWeights& w) {
       g.LayerNorm(x, {w.bias, w.bias});
     }},
    {"ConcatOfOtherRows", "concat: (5, 10) and (6, 10) differ in rows",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Concat({x, g.Rows(x, 0, 5)});
     }},
    {"ConcatOfNothing", "concat: nothing",
     [](Graph& g, Value, const LinearWeights&) { g.Concat({}); }},
    {"ConcatRowsOfOtherColumns", "concat_rows: (6, 4) and (6, 10)",
     [](Graph& g, Value x, const LinearWeights&) {
       g.ConcatRows({x, g.Columns(x, 0, 4)});
     }},
    {"RepeatOfManyRows", "repeat_rows: input (6, 10)",
     [](Graph& g, Value x, const LinearWeights&) { g.RepeatRows(x, 2); }},
    {"AffineOfOtherWidth", "affine: 1 factors",
     [](Graph& g, Value x, const LinearWeights&) { g.Affine(x, {1.0f}, {0.0f}); }},
    {"EmbeddingOfFloats", "embedding: expected int32",
     [](Graph& g, Value x, const LinearWeights& w) { g.Embedding(x, w.weight); }},
    {"LinearOfIntegers", "softmax: input is int32, expected float32",
     [](Graph& g, Value, const LinearWeights&) { g.Softmax(g.Input("i", {4}, DType::kI32)); }},
    {"StepOutsideALoop", "step_row", [](Graph& g, Value x, const LinearWeights&) { g.StepRow(x); }},
    {"LoopLongerThanTheRows", "step_row: (6, 10) has fewer rows",
     [](Graph& g, Value x, const LinearWeights&) {
       g.BeginLoop(7);
       g.StepRow(x);
     }},
    {"StoreIntoNoBuffer", "store_rows",
     [](Graph& g, Value x, const LinearWeights&) {
       g.BeginLoop(2);
       g.StoreRows(x, g.StepRow(x));
     }},
    {"FirstRowOfOtherWidth", "previous_row: first row (1, 3)",
     [](Graph& g, Value, const LinearWeights&) {
       const Value buffer = g.Buffer({2, 4});
       g.BeginLoop(2);
       g.PreviousRow(buffer, g.Zeros({1, 3}));
     }},
    {"BufferShorterThanTheLoop", "last_rows: expected a buffer",
     [](Graph& g, Value, const LinearWeights&) {
       const Value buffer = g.Buffer({2, 4});
       g.BeginLoop(3);
       g.LastRows(buffer, 2);
     }},
    {"FloatsIntoABufferOfIntegers", "store_rows: input is float32, expected int32",
     [](Graph& g, Value, const LinearWeights&) {
       const Value buffer = g.Buffer({2, 4}, DType::kI32);
       g.BeginLoop(2);
       g.StoreRows(buffer, g.Zeros({1, 4}));
     }},
    {"PickFromManyRows", "pick: logits (6, 10)",
     [](Graph& g, Value x, const LinearWeights&) {
       g.Pick(x, g.Zeros({1, 2}), g.Zeros({1, 1}));
     }},
    {"TooManyOps", "more than 16384 ops",
     [](Graph& g, Value x, const LinearWeights&) {
       for (int i = 0; i < 20000; ++i) x = g.Softmax(x);
     }},
    {"BufferInsideALoop", "buffer: declare it before",
     [](Graph& g, Value, const LinearWeights&) {
       g.BeginLoop(2);
       g.Buffer({2, 2});
     }},
    {"LoopInsideALoop", "loop: loops do not nest",
     [](Graph& g, Value, const LinearWeights&) {
       g.BeginLoop(2);
       g.BeginLoop(2);
     }},
    {"LoopOfNoSteps", "loop: loops do not nest and run at least once",
     [](Graph& g, Value, const LinearWeights&) { g.BeginLoop(0); }},
    {"LoopEndedTwice", "loop: ended before",
     [](Graph& g, Value, const LinearWeights&) { g.EndLoop(); }},
    {"OutputInsideALoop", "output: declare it after",
     [](Graph& g, Value x, const LinearWeights&) {
       g.BeginLoop(2);
       g.Output("y", x);
     }},
    {"ValueThatWasNeverMade", "a value is used that was never made",
     [](Graph& g, Value, const LinearWeights&) { g.Softmax(Value{}); }},
    {"InputOfNoRows", "input: shape (0, 3)",
     [](Graph& g, Value, const LinearWeights&) {
       g.Input("z", {0, 3});
     }},
};

class GraphMistakeTest : public testing::TestWithParam<Mistake> {};
INSTANTIATE_TEST_SUITE_P(All, GraphMistakeTest, testing::ValuesIn(kMistakes),
                         [](const auto& test) { return test.param.name; });

TEST_P(GraphMistakeTest, IsOneSentenceThatNamesTheScope) {
  Tensors tensors;
  const LinearWeights w{tensors.Make({4, 8}, 1), tensors.Make({4}, 2)};
  Graph g;
  const Value x = g.Input("x", {6, 10});
  {
    const Graph::Scope outer(g, "net");
    const Graph::Scope inner(g, "block.3");
    GetParam().declare(g, x, w);
  }
  const std::string message = g.status().message();
  EXPECT_EQ(g.status().code(), Code::kBadWeights);
  EXPECT_EQ(message.rfind(std::string("net/block.3: ") + GetParam().expect, 0), 0u) << message;
  // The first mistake stays; what follows does nothing.
  const std::size_t nodes = g.nodes().size();
  g.Output("y", g.Softmax(g.Add(x, g.Rows(x, 0, 1))));
  EXPECT_EQ(g.status().message(), message);
  EXPECT_EQ(g.nodes().size(), nodes);
  WeightCache cache(kernels::BestTable(), nullptr);
  EXPECT_FALSE(Plan::Make(std::move(g), cache).ok());
}

}  // namespace
}  // namespace gestus::test
