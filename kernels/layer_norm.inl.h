// Layer normalisation (Ba, Kiros & Hinton 2016), in two passes over each row.
#ifndef GESTUS_KERNELS_LAYER_NORM_INL_H_
#define GESTUS_KERNELS_LAYER_NORM_INL_H_

#include <cmath>
#include <limits>

#include "kernels/columns.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

/// Sums of x - shift and of its square over a row.
struct Moments {
  float sum, squares;
};

template <class Arch>
GESTUS_INLINE Moments row_moments(const float* x, std::size_t cols, float shift) {
  using B = Batch<Arch>;
  constexpr std::size_t kWidth = B::size;
  const B offset(shift);
  // Two chains of sums each hide the latency of the additions.
  B sum0(0.0f), sum1(0.0f), squares0(0.0f), squares1(0.0f);
  std::size_t j = 0;
  for (; j + 2 * kWidth <= cols; j += 2 * kWidth) {
    const B d0 = B::load_unaligned(x + j) - offset;
    const B d1 = B::load_unaligned(x + j + kWidth) - offset;
    sum0 += d0;
    sum1 += d1;
    squares0 = multiply_add(d0, d0, squares0);
    squares1 = multiply_add(d1, d1, squares1);
  }
  Moments m{xsimd::hadd(sum0 + sum1), xsimd::hadd(squares0 + squares1)};
  for (; j < cols; ++j) {
    const float d = x[j] - shift;
    m.sum += d;
    m.squares += d * d;
  }
  return m;
}

/// A row whose squares overflow float.  Infinities and NaN in the input end here too.
GESTUS_INLINE void layer_norm_row_in_double(float* y, const float* x, const float* gamma,
                                            const float* beta, float eps, std::size_t cols) {
  double mean = 0.0, variance = 0.0;
  for (std::size_t j = 0; j < cols; ++j) mean += x[j];
  mean /= static_cast<double>(cols);
  for (std::size_t j = 0; j < cols; ++j) variance += (x[j] - mean) * (x[j] - mean);
  variance /= static_cast<double>(cols);
  const double factor = 1.0 / __builtin_sqrt(variance + eps);
  for (std::size_t j = 0; j < cols; ++j) {
    y[j] = static_cast<float>((x[j] - mean) * factor * gamma[j] + beta[j]);
  }
}

template <class Arch>
void f32_layer_norm(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                    const float* gamma, const float* beta, float eps, std::size_t rows,
                    std::size_t cols) {
  const float count = static_cast<float>(cols);
  for (std::size_t r = 0; r < rows; ++r) {
    const float* in = row_of(x, r, x_stride);
    float* out = row_of(y, r, y_stride);
    const float rough_mean = row_moments<Arch>(in, cols, 0.0f).sum / count;
    const Moments m = row_moments<Arch>(in, cols, rough_mean);
    if (!(m.squares <= std::numeric_limits<float>::max())) {
      layer_norm_row_in_double(out, in, gamma, beta, eps, cols);
      continue;
    }
    // What the rounding of the first mean left over corrects mean and variance: without it a row of
    // one repeated value would come out as the sign of a rounding error.
    const float rest = m.sum / count;
    const float difference = m.squares / count - rest * rest;
    const float variance = difference > 0.0f ? difference : 0.0f;
    const Batch<Arch> mean(rough_mean + rest);
    const Batch<Arch> factor(1.0f / __builtin_sqrtf(variance + eps));
    for_columns<Arch>(out, cols, [&](const auto& load) {
      return multiply_add((load(in) - mean) * factor, load(gamma), load(beta));
    });
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_LAYER_NORM_INL_H_
