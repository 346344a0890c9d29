#include "models/audio/fft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace gestus::audio {
namespace {

// The definition of the transform.
double PowerOf(const std::vector<double>& x, std::size_t bin) {
  std::complex<double> sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double turns = static_cast<double>(n * bin % x.size()) / static_cast<double>(x.size());
    sum += x[n] * std::polar(1.0, -2 * std::numbers::pi * turns);
  }
  return std::norm(sum);
}

class FftTest : public testing::TestWithParam<std::size_t> {};

TEST_P(FftTest, IsTheDefinition) {
  const std::size_t size = GetParam();
  std::vector<double> x(size);
  for (std::size_t i = 0; i < size; ++i) x[i] = std::sin(0.7 * static_cast<double>(i * i % 101));
  const std::vector<float> x32(x.begin(), x.end());
  RealFft<double> fft(size);
  RealFft<float> fft32(size);
  ASSERT_EQ(fft.bins(), size / 2 + 1);
  std::vector<double> power(fft.bins());
  std::vector<float> power32(fft.bins());
  fft.Power(x.data(), power.data());
  fft32.Power(x32.data(), power32.data());
  const double scale =
      static_cast<double>(size * size);  // the largest power that |x| <= 1 can have
  for (std::size_t bin = 0; bin < fft.bins(); ++bin) {
    const double want = PowerOf(x, bin);
    EXPECT_NEAR(power[bin], want, 1e-14 * scale) << bin;
    EXPECT_NEAR(power32[bin], want, 1e-6 * scale) << bin;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FftTest, testing::Values(2, 4, 6, 12, 30, 256, 400, 512, 2048));

}  // namespace
}  // namespace gestus::audio
