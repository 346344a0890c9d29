// The tolerances of all tests, each derived where it stands and written down once.  A test that
// fails has found an error or shows that a derivation is wrong; widening is neither.
//
// eps is the distance of 1 from the next float, 2^-23; one rounding is at most eps / 2, relative.
#ifndef GESTUS_TESTS_TOLERANCE_H_
#define GESTUS_TESTS_TOLERANCE_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "kernels/kernels.h"

namespace gestus::test {

inline constexpr double kEps = std::numeric_limits<float>::epsilon();
/// Results below the smallest normal number may be flushed to zero.
inline constexpr double kFlush = std::numeric_limits<float>::min();

/// Floats between a and b, +0 and -0 being one.
inline std::int64_t UlpDistance(float a, float b) {
  const auto order = [](float x) -> std::int64_t {
    const auto bits = std::bit_cast<std::int32_t>(x);
    return bits < 0 ? -static_cast<std::int64_t>(bits & 0x7fffffff) : bits;
  };
  return std::llabs(order(a) - order(b));
}

/// A sum of k products in any order, fused or not.  Each of the k additions rounds the running sum,
/// which for terms of random sign stays near sqrt(k) max|a| max|b|, and the k roundings add up like
/// sqrt(k) of them: k max|a| max|b| eps / 2, doubled for what random means.
inline double GemmTolerance(std::size_t k, double max_a, double max_b) {
  return kEps * static_cast<double>(k) * max_a * max_b;
}

/// Error of an activation whose argument x is exact: the table of the functions.  An ULP counts as
/// eps |y| here, its size at the bottom of a binade (at the top, two floats).
inline double ActivationTolerance(kernels::Activation act, double x, double y) {
  using kernels::Activation;
  const double ulp = kEps * std::fabs(y);
  switch (act) {
    case Activation::kNone:
    case Activation::kRelu:
      return 0.0;
    case Activation::kLeakyRelu:
      return ulp + kFlush;
    case Activation::kTanh:
    case Activation::kSigmoid:
      return 4.0 * ulp + kFlush;
    case Activation::kGeluErf:
    case Activation::kGeluTanh:
      // 1 + erf cancels for negative x: an absolute error of x/2 times that of erf.
      return 3e-7 * std::fmax(1.0, std::fabs(x));
  }
  return 0.0;
}

/// Largest slope of an activation: what it makes of an error of its argument.
inline double ActivationSlope(kernels::Activation act) {
  using kernels::Activation;
  if (act == Activation::kGeluErf || act == Activation::kGeluTanh) return 1.13;
  return act == Activation::kSigmoid ? 0.25 : 1.0;
}

/// exp itself is within 3 ULP; the sum of `cols` terms and the division add one rounding each, and
/// the rounding of x - max is an absolute error of the exponent, so a relative one of the result.
inline double SoftmaxTolerance(std::size_t cols, double range, double y) {
  return kEps * (4.0 + static_cast<double>(cols) / 2.0 + range / 2.0) * y + kFlush;
}

/// (x - mean) / sigma * gamma + beta.  The mean and the subtraction round to eps max|x|, divided by
/// sigma; the variance gathers cols / 2 roundings of its sum; five more operations follow.
inline double LayerNormTolerance(std::size_t cols, double max_x, double sigma, double normal,
                                 double gamma, double y) {
  const double shift = kEps * max_x / sigma;
  const double scale = kEps * (static_cast<double>(cols) / 4.0 + 5.0) * std::fabs(normal);
  return (shift + scale) * std::fabs(gamma) + kEps * std::fabs(y);
}

struct AttentionScale {
  std::size_t keys, head_dim;
  double scale, max_q, max_k, max_v;
};

/// A score is wrong by that of a product of head_dim terms and by the rounding of its size; the
/// error of a score is the relative error of a weight.  The weights stand above and below the line,
/// so twice that, and both sums of `keys` terms round.
inline double AttentionTolerance(const AttentionScale& s) {
  const double largest = static_cast<double>(s.head_dim) * s.max_q * s.max_k * std::fabs(s.scale);
  const double score =
      GemmTolerance(s.head_dim, s.max_q, s.max_k) * std::fabs(s.scale) + kEps * largest;
  return s.max_v * (2.0 * (score + 4.0 * kEps) + kEps * static_cast<double>(s.keys));
}

/// Gates are wrong by e; sigmoids have slope 1/4, tanh 1, and 4 ULP of each function's error.
inline double LstmTolerance(std::size_t hidden, double max_w, double max_h, double max_c) {
  const double e = GemmTolerance(hidden, max_w, max_h) + 4.0 * kEps;
  const double cell = e * (max_c / 4.0 + 1.25) + 8.0 * kEps * (max_c + 1.0);
  return cell + e / 4.0 + 8.0 * kEps;
}

}  // namespace gestus::test

#endif  // GESTUS_TESTS_TOLERANCE_H_
