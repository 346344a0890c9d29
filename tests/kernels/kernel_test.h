// What the kernel tests share: one fixture with the ISA as its parameter, and matrices that end at
// an unreadable page, are poisoned with NaN between their rows and start at any alignment.
#ifndef GESTUS_TESTS_KERNELS_KERNEL_TEST_H_
#define GESTUS_TESTS_KERNELS_KERNEL_TEST_H_

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "kernels/kernels.h"
#include "tests/kernels/guarded.h"
#include "tests/tolerance.h"

namespace gestus::test {

using kernels::Activation;
using kernels::Isa;

class KernelTest : public ::testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    table_ = kernels::TableFor(GetParam());
    if (table_ == nullptr) {
      GTEST_SKIP() << "this machine or this build has no " << kernels::IsaName(GetParam());
    }
  }

  const kernels::KernelTable* table_ = nullptr;
  /// The double-precision reference; its packed weights are the weights.
  const kernels::KernelTable* reference_ = kernels::TableFor(Isa::kScalar);
};

inline std::string IsaOfParam(const ::testing::TestParamInfo<Isa>& info) {
  return kernels::IsaName(info.param);
}

#define GESTUS_TEST_ON_EVERY_ISA(suite)                                                  \
  INSTANTIATE_TEST_SUITE_P(                                                              \
      Isa, suite, ::testing::ValuesIn(kernels::kAllIsas), IsaOfParam)

/// 1 .. 2W+1 for the widest vectors, then primes and round sizes.
std::vector<std::size_t> AwkwardSizes();

/// Allowed error of element (row, column), whose true value is `want`.
using Tolerance = std::function<double(std::size_t row, std::size_t column, double want)>;

/// Compares all elements and the padding of `got`; a failure tells index, values, ULP and seed.
::testing::AssertionResult Close(const Matrix& got, const Matrix& want, const Tolerance& tolerance);
/// The same, bit for bit but for the sign of zero.
::testing::AssertionResult Same(const Matrix& got, const Matrix& want);

}  // namespace gestus::test

#endif  // GESTUS_TESTS_KERNELS_KERNEL_TEST_H_
