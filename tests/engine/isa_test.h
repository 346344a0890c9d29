// A fixture whose parameter is the instruction set, and how a graph is run with it.
#ifndef GESTUS_TESTS_ENGINE_ISA_TEST_H_
#define GESTUS_TESTS_ENGINE_ISA_TEST_H_

#include <gtest/gtest.h>

#include "engine/plan.h"
#include "engine/session.h"
#include "kernels/kernels.h"

namespace gestus::test {

using kernels::Isa;

class IsaTest : public testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    table_ = kernels::TableFor(GetParam());
    if (table_ == nullptr) GTEST_SKIP() << "no " << kernels::IsaName(GetParam()) << " here";
  }
  /// A session of the graph, ready for its inputs.
  std::unique_ptr<Session> Make(Graph graph, const PlanOptions& plan_options = {},
                                const SessionOptions& options = {}) const {
    WeightCache cache(*table_, nullptr);
    auto plan = Plan::Make(std::move(graph), cache, plan_options);
    EXPECT_TRUE(plan.ok()) << plan.status().message();
    if (!plan.ok()) return nullptr;
    auto session = Session::Create(*plan, options);
    EXPECT_TRUE(session.ok()) << session.status().message();
    return session.ok() ? *std::move(session) : nullptr;
  }

  const kernels::KernelTable* table_ = nullptr;
};

#define GESTUS_TEST_ON_EVERY_ISA(suite)                                      \
  INSTANTIATE_TEST_SUITE_P(Isa, suite, testing::ValuesIn(kernels::kAllIsas), \
                           [](const auto& test) { return kernels::IsaName(test.param); })

}  // namespace gestus::test

#endif  // GESTUS_TESTS_ENGINE_ISA_TEST_H_
