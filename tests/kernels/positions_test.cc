// Sinusoidal positions against values worked out by hand from the paper's formula.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/kernels.h"
#include "tests/tolerance.h"

namespace gestus::test {
namespace {

TEST(PositionsTest, FirstRowsOfFourDimensions) {
  std::vector<float> out(3 * 4);
  kernels::sinusoidal_positions(out.data(), 3, 4);
  const double want[] = {0,
                         1,
                         0,
                         1,
                         0.8414709848,
                         0.5403023059,
                         0.0099998333,
                         0.9999500004,
                         0.9092974268,
                         -0.4161468365,
                         0.0199986667,
                         0.9998000067};
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], want[i], kEps) << i;
}

// An odd d ends with a sine; d itself stays the divisor of the exponent.
TEST(PositionsTest, OddDimension) {
  std::vector<float> out(2 * 3);
  kernels::sinusoidal_positions(out.data(), 2, 3);
  EXPECT_NEAR(out[5], std::sin(1.0 / std::pow(10000.0, 2.0 / 3.0)), kEps);
}

}  // namespace
}  // namespace gestus::test
