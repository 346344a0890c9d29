// Comparison of matrices and the list of awkward sizes.
#include "tests/kernels/kernel_test.h"

namespace gestus::test {
namespace {

bool Agrees(float got, float want, double tolerance) {
  if (std::isnan(want)) return std::isnan(got);
  if (std::isinf(want) || std::isinf(got)) return got == want;
  return std::fabs(static_cast<double>(got) - want) <= tolerance;
}

}  // namespace

std::vector<std::size_t> AwkwardSizes() {
  std::vector<std::size_t> sizes;
  for (std::size_t n = 1; n <= 33; ++n) sizes.push_back(n);
  for (const std::size_t n : {37, 48, 61, 64, 67, 127, 256, 769}) sizes.push_back(n);
  return sizes;
}

::testing::AssertionResult Close(const Matrix& got, const Matrix& want,
                                 const Tolerance& tolerance) {
  for (std::size_t i = 0; i < want.rows(); ++i) {
    for (std::size_t j = 0; j < want.cols(); ++j) {
      const double allowed = tolerance(i, j, want(i, j));
      if (Agrees(got(i, j), want(i, j), allowed)) continue;
      return ::testing::AssertionFailure()
             << "at (" << i << ", " << j << ") of (" << want.rows() << ", " << want.cols()
             << "): got " << got(i, j) << ", want " << want(i, j) << ", which is "
             << UlpDistance(got(i, j), want(i, j)) << " ULP; allowed " << allowed << ", seed "
             << want.seed();
    }
  }
  const std::ptrdiff_t touched = got.TouchedGap();
  if (touched < 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "the padding at offset " << touched << " was written";
}

::testing::AssertionResult Same(const Matrix& got, const Matrix& want) {
  return Close(got, want, [](std::size_t, std::size_t, double) { return 0.0; });
}

}  // namespace gestus::test
