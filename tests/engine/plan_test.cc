// Planning: what is fused, where values lie, what is refused.
#include "engine/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/engine/every_op.h"
#include "tests/engine/isa_test.h"
#include "tests/tolerance.h"

namespace gestus::test {
namespace {

std::shared_ptr<const Plan> MakePlan(Graph graph, const PlanOptions& options = {}) {
  WeightCache cache(kernels::BestTable(), nullptr);
  auto plan = Plan::Make(std::move(graph), cache, options);
  EXPECT_TRUE(plan.ok()) << plan.status().message();
  return plan.ok() ? *plan : nullptr;
}

/// The steps of a run one after the other, each loop twice: two rounds show everything that one
/// step can leave to the next.
std::vector<std::size_t> Unrolled(const Plan& plan) {
  std::vector<std::size_t> order;
  std::size_t loop = 0;
  for (std::size_t i = 0; i < plan.steps().size();) {
    const bool loops = loop < plan.loops().size() && plan.loops()[loop].begin == i;
    const std::size_t end = loops ? plan.loops()[loop].end : i + 1;
    for (int round = 0; round < (loops ? 2 : 1); ++round) {
      for (std::size_t op = i; op < end; ++op) order.push_back(op);
    }
    if (loops) ++loop;
    i = end;
  }
  return order;
}

/// An account of lifetimes of its own: walks backwards over the run, where a value lives from its
/// first write to its last read.
void ExpectNoLiveValueIsOverwritten(const Plan& plan) {
  const std::vector<std::size_t> order = Unrolled(plan);
  const auto root_of = [&](int id) { return static_cast<std::size_t>(plan.Root(id)); };
  const auto apart = [&](std::size_t a, std::size_t b) {
    const Plan::Storage &x = plan.storage()[a], &y = plan.storage()[b];
    return x.offset + x.bytes <= y.offset || y.offset + y.bytes <= x.offset;
  };
  // Values begin anew in each round of a loop, where a step first writes to them; buffers keep
  // their rows from round to round and begin where they are first named.
  std::vector<std::size_t> first_step(plan.values().size(), order.size());
  std::vector<std::size_t> first_time = first_step;
  for (std::size_t time = order.size(); time-- > 0;) {
    const Node& node = plan.steps()[order[time]].node;
    const std::size_t out = root_of(node.output);
    first_step[out] = std::min(first_step[out], order[time]);
    first_time[out] = time;
    for (int in : node.inputs) first_time[root_of(in)] = time;
  }
  std::vector<bool> live(plan.values().size(), false);
  const auto wake = [&](int id) {
    const std::size_t root = root_of(id);
    if (plan.storage()[root].in_arena) live[root] = true;
  };
  for (const NamedValue& out : plan.outputs()) wake(out.id);
  for (const NamedValue& in : plan.inputs()) wake(in.id);
  for (std::size_t time = order.size(); time-- > 0;) {
    const Node& node = plan.steps()[order[time]].node;
    const std::size_t out = root_of(node.output);
    ASSERT_TRUE(plan.storage()[out].in_arena) << "step " << order[time];
    for (int in : node.inputs) wake(in);
    for (std::size_t id = 0; id < live.size(); ++id) {
      ASSERT_TRUE(!live[id] || id == out || apart(id, out))
          << "step " << order[time] << " (" << Name(node.op) << ") writes value " << out
          << " over value " << id;
    }
    if (first_step[out] == order[time] && !plan.values()[out].buffer) {
      live[out] = false;
      for (int in : node.inputs) wake(in);
    }
    for (std::size_t id = 0; id < live.size(); ++id) {
      if (plan.values()[id].buffer && first_time[id] == time) live[id] = false;
    }
  }
}

void ExpectPlacesOfTheirOwn(const Plan& plan) {
  std::uint64_t sum = 0, peak = 0;
  const auto& storage = plan.storage();
  for (std::size_t a = 0; a < storage.size(); ++a) {
    if (!storage[a].in_arena) continue;
    EXPECT_EQ(storage[a].offset % 64, 0u);
    EXPECT_LE(storage[a].offset + storage[a].bytes, plan.arena_bytes());
    sum += storage[a].bytes;
    peak = std::max(peak, storage[a].offset + storage[a].bytes);
    for (std::size_t b = 0; b < a; ++b) {
      const bool together = storage[b].in_arena && storage[a].first <= storage[b].last &&
                            storage[b].first <= storage[a].last;
      const bool apart = storage[a].offset + storage[a].bytes <= storage[b].offset ||
                         storage[b].offset + storage[b].bytes <= storage[a].offset;
      EXPECT_TRUE(!together || apart) << "values " << b << " and " << a;
    }
  }
  EXPECT_LE(peak, plan.arena_bytes());
  EXPECT_LE(peak, sum);
}

TEST(PlanTest, ValuesThatLiveTogetherLieApart) {
  for (const bool fuse : {true, false}) {
    for (const bool taps : {true, false}) {
      const Model model = MakeEveryOp(kernels::BestTable(), {.fuse = fuse, .taps = taps});
      ASSERT_NE(model.plan, nullptr);
      ExpectPlacesOfTheirOwn(*model.plan);
      ExpectNoLiveValueIsOverwritten(*model.plan);
    }
  }
}

TEST(PlanTest, PlacesAreUsedAgain) {
  Graph g;
  Value x = g.Input("x", {100, 100});
  for (int i = 0; i < 20; ++i) x = g.Softmax(x);
  g.Output("y", x);
  const auto plan = MakePlan(std::move(g));
  ExpectPlacesOfTheirOwn(*plan);
  // The input stays; two more places serve the chain.
  EXPECT_EQ(plan->arena_bytes(), 3u * 40000);
}

TEST(PlanTest, TheArenaIsHardlyLargerThanItMustBe) {
  const Model model = MakeEveryOp(kernels::BestTable());
  EXPECT_GE(model.plan->arena_bytes(), model.plan->live_bytes());
  EXPECT_LE(model.plan->arena_bytes(), model.plan->live_bytes() * 21 / 20);
}

TEST(PlanTest, TheArenaIsBounded) {
  const auto make = [](std::uint64_t limit) {
    Graph g;
    g.Output("y", g.Softmax(g.Input("x", {1000, 16})));
    WeightCache cache(kernels::BestTable(), nullptr);
    return Plan::Make(std::move(g), cache, {.max_arena_bytes = limit});
  };
  EXPECT_TRUE(make(128000).ok());
  const auto refused = make(127999);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.status().code(), Code::kResourceExhausted);
  EXPECT_EQ(refused.status().message(),
            "activations need more than 127999 bytes, the limit that was set");
  // A limit that arithmetic could overflow must refuse before anything is allocated.
  Graph huge;
  huge.Output("y", huge.Softmax(huge.Input("x", {1 << 24, 1 << 24})));
  WeightCache cache(kernels::BestTable(), nullptr);
  EXPECT_FALSE(Plan::Make(std::move(huge), cache).ok());
}

std::vector<std::string> Ops(const Plan& plan) {
  std::vector<std::string> names;
  for (const Plan::Step& step : plan.steps()) names.push_back(Name(step.node.op));
  return names;
}

TEST(PlanTest, FusesActivationResidualAndConcat) {
  Tensors tensors;
  const LinearWeights w{tensors.Make({16, 16}, 1), {}};
  const auto declare = [&] {
    Graph g;
    const Value x = g.Input("x", {4, 16});
    const Value a = g.Activate(g.Linear(x, w), Activation::kRelu);
    const Value b = g.Add(x, g.Linear(a, w));
    g.Output("y", g.Concat({b, g.Softmax(b),
                            g.LayerNorm(x, {tensors.Make({16}, 2), tensors.Make({16}, 3)})}));
    return g;
  };
  const auto fused = MakePlan(declare());
  EXPECT_EQ(Ops(*fused),
            (std::vector<std::string>{"linear", "linear", "softmax", "layer_norm", "concat"}));
  EXPECT_TRUE(fused->steps()[1].node.residual);
  const auto plain = MakePlan(declare(), {.fuse = false});
  EXPECT_EQ(Ops(*plain), (std::vector<std::string>{"linear", "activate", "linear", "add", "softmax",
                                                   "layer_norm", "concat"}));
  EXPECT_LE(fused->arena_bytes(), plain->arena_bytes());
}

TEST(PlanTest, RowsThatWouldCrowdTheCacheLieApart) {
  Tensors tensors;
  const LinearWeights wide{tensors.Make({512, 16}, 1), {}}, narrow{tensors.Make({16, 512}, 2), {}};
  std::vector<float> results[2];
  for (const bool seen : {false, true}) {
    Graph g;
    const Value x = g.Input("x", {3, 5, 16});
    const Value inner = g.Linear(x, wide);
    g.Output("y", g.Linear(inner, narrow));
    if (seen) g.Output("inner", inner);  // whoever reads it may take it for dense
    const auto plan = MakePlan(std::move(g));
    EXPECT_EQ(plan->values()[static_cast<std::size_t>(inner.id)].row_stride, seen ? 512 : 528);
    auto session = Session::Create(plan);
    ASSERT_TRUE(session.ok());
    for (int i = 0; i < 3 * 5 * 16; ++i)
      (*session)->Input("x").f32[i] = 0.01f * static_cast<float>(i * 37 % 101);
    (*session)->Run();
    const ValueView y = (*session)->Output("y");
    results[seen].assign(y.f32, y.f32 + y.shape.NumElements());
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(PlanTest, DropsWhatNoOutputNeeds) {
  Graph g;
  const Value x = g.Input("x", {4, 4});
  const Value unused = g.Buffer({4, 4});
  g.BeginLoop(4);
  g.StoreRows(unused, g.StepRow(x));
  g.EndLoop();
  g.Softmax(x);
  g.Output("y", g.Add(x, x));
  const auto plan = MakePlan(std::move(g));
  EXPECT_EQ(Ops(*plan), std::vector<std::string>{"add"});
  auto session = Session::Create(plan);
  ASSERT_TRUE(session.ok());
  (*session)->Input("x").f32[5] = 2;
  (*session)->Run();
  EXPECT_EQ((*session)->Output("y").f32[5], 4);
}

TEST(PlanTest, PacksAWeightOnceForAllPlans) {
  Tensors tensors;
  const LinearWeights w{tensors.Make({16, 16}, 1), {}};
  WeightCache cache(kernels::BestTable(), nullptr);
  std::size_t packed = 0;
  for (int i = 0; i < 3; ++i) {
    Graph g;
    const Value x = g.Input("x", {4, 16});
    g.Output("y", g.Linear(g.Linear(x, w), w));
    ASSERT_TRUE(Plan::Make(std::move(g), cache).ok());
    if (i == 0) packed = cache.packed_bytes();
    EXPECT_EQ(cache.packed_bytes(), packed);
  }
  EXPECT_GE(packed, std::size_t{16 * 16 * 4});
  EXPECT_LT(packed, std::size_t{2 * 16 * 64 * 4});
}

TEST(PlanTest, TextNamesScopesAndOps) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const std::string text = model.plan->ToString();
  for (const char* part :
       {"layers", "steps", "lstm", "attention", "linear+bias", "x loop", "GFLOP"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
}

class PlanRunTest : public IsaTest {};
GESTUS_TEST_ON_EVERY_ISA(PlanRunTest);

std::vector<float> RunOnce(const Model& model, std::uint32_t seed) {
  auto session = Session::Create(model.plan);
  EXPECT_TRUE(session.ok());
  FillEveryOp(**session, seed);
  (*session)->Run();
  return AllOutputs(**session);
}

TEST_P(PlanRunTest, FusionChangesNoMoreThanRounding) {
  const Model fused = MakeEveryOp(*table_), plain = MakeEveryOp(*table_, {.fuse = false});
  const auto a = RunOnce(fused, 3), b = RunOnce(plain, 3);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_LT(fused.plan->steps().size(), plain.plan->steps().size());
  double largest = 1;
  for (float v : b) largest = std::max(largest, std::fabs(double{v}));
  // The same products in the same order: only epilogues round elsewhere, once for each of the
  // steps, and the steps' slopes stay near 1.
  const double tolerance = kEps * largest * static_cast<double>(plain.plan->steps().size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST_P(PlanRunTest, TapsChangeNothingAndHoldTheValue) {
  const Model plain = MakeEveryOp(*table_), tapped = MakeEveryOp(*table_, {.taps = true});
  auto session = Session::Create(tapped.plan);
  ASSERT_TRUE(session.ok());
  FillEveryOp(**session, 3);
  (*session)->Run();
  const ValueView tap = (*session)->Output("tap/layers/norm");
  ASSERT_NE(tap.f32, nullptr);
  EXPECT_EQ(tap.shape, (Shape{12, 24}));
  EXPECT_EQ((*session)->Output("layers/norm").f32, nullptr);
  std::vector<float> with = AllOutputs(**session);
  const std::vector<float> without = RunOnce(plain, 3);
  with.resize(without.size());  // the tap comes last
  EXPECT_EQ(std::memcmp(with.data(), without.data(), with.size() * sizeof(float)), 0);
}

TEST_P(PlanRunTest, ReadsNothingThatItDidNotWrite) {
  for (const bool fuse : {true, false}) {
    const Model model = MakeEveryOp(*table_, {.fuse = fuse});
    auto session = Session::Create(model.plan);
    ASSERT_TRUE(session.ok());
    // Values that are not inputs hold NaN before the run; one that is read first would spread it.
    const ValueView x = (*session)->Input("x");
    auto* arena =
        reinterpret_cast<std::byte*>(x.f32) -
        model.plan->storage()[static_cast<std::size_t>(model.plan->inputs()[0].id)].offset;
    auto* floats = reinterpret_cast<float*>(arena);
    std::fill(floats, floats + model.plan->arena_bytes() / sizeof(float),
              std::numeric_limits<float>::quiet_NaN());
    FillEveryOp(**session, 3);
    (*session)->Run();
    const auto poisoned = AllOutputs(**session), clean = RunOnce(model, 3);
    EXPECT_EQ(std::memcmp(poisoned.data(), clean.data(), clean.size() * sizeof(float)), 0);
    for (float v : poisoned) ASSERT_TRUE(std::isfinite(v));
  }
}

}  // namespace
}  // namespace gestus::test
