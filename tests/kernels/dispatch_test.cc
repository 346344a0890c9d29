// The choice of a table: complete, named as GESTUS_ISA spells it, and the same for all threads.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "kernels/kernels.h"

namespace gestus::test {
namespace {

using kernels::Isa;
using kernels::KernelTable;

TEST(DispatchTest, NamesGoBothWays) {
  for (const Isa isa : kernels::kAllIsas) {
    Isa parsed = Isa::kNeon;
    ASSERT_TRUE(kernels::ParseIsa(kernels::IsaName(isa), &parsed));
    EXPECT_EQ(parsed, isa);
  }
  Isa untouched = Isa::kAvx2;
  for (const char* wrong : {"", "AVX2", "avx", "avx5120", "scalar "}) {
    EXPECT_FALSE(kernels::ParseIsa(wrong, &untouched)) << wrong;
  }
  EXPECT_EQ(untouched, Isa::kAvx2);
}

TEST(DispatchTest, TablesSayWhatTheyAre) {
  ASSERT_NE(kernels::TableFor(Isa::kScalar), nullptr);
  for (const Isa isa : kernels::kAllIsas) {
    const KernelTable* table = kernels::TableFor(isa);
    if (table == nullptr) continue;
    EXPECT_EQ(table->isa, isa);
    EXPECT_STREQ(table->name, kernels::IsaName(isa));
    EXPECT_GT(table->gemm_block_n, 0u);
    EXPECT_GT(table->lstm_block, 0u);
  }
}

TEST(DispatchTest, AllThreadsGetTheSameTable) {
  std::vector<const KernelTable*> seen(8);
  std::vector<std::thread> threads;
  for (auto& slot : seen) threads.emplace_back([&slot] { slot = &kernels::BestTable(); });
  for (std::thread& thread : threads) thread.join();
  for (const KernelTable* table : seen) EXPECT_EQ(table, &kernels::BestTable());
}

// The choice is made once per process, so each value is tried in a child of its own.  GoogleTest
// runs suites named DeathTest first, when this process has not chosen yet.
TEST(DispatchDeathTest, EnvironmentLowersTheChoice) {
  const auto exit_if = [](const char* value, Isa want, Isa or_else) {
    setenv("GESTUS_ISA", value, 1);
    const Isa got = kernels::BestTable().isa;
    std::exit(got == want || got == or_else ? 0 : 1);
  };
  unsetenv("GESTUS_ISA");
  Isa best = Isa::kScalar, second = Isa::kScalar;
  for (const Isa isa : kernels::kAllIsas) {
    if (kernels::TableFor(isa) == nullptr) continue;
    // Where bfloat16 is the most capable it may be avoided (kernels/dispatch.cc:SlowBf16).
    second = isa == Isa::kAvx512Bf16 ? best : isa;
    best = isa;
    EXPECT_EXIT(exit_if(kernels::IsaName(isa), isa, isa), ::testing::ExitedWithCode(0), "")
        << kernels::IsaName(isa);
  }
  EXPECT_EXIT(exit_if("altivec", best, second), ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(exit_if("", best, second), ::testing::ExitedWithCode(0), "");
  for (const Isa isa : kernels::kAllIsas) {
    if (kernels::TableFor(isa) != nullptr) continue;
    EXPECT_EXIT(exit_if(kernels::IsaName(isa), best, second), ::testing::ExitedWithCode(0), "")
        << kernels::IsaName(isa);
  }
}

}  // namespace
}  // namespace gestus::test
