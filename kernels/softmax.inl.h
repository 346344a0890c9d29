// Softmax of each row, the maximum subtracted first.
#ifndef GESTUS_KERNELS_SOFTMAX_INL_H_
#define GESTUS_KERNELS_SOFTMAX_INL_H_

#include <limits>

#include "kernels/columns.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

template <class Arch>
GESTUS_INLINE float row_maximum(const float* x, std::size_t cols) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  Batch<Arch> best(-std::numeric_limits<float>::infinity());
  std::size_t j = 0;
  for (; j + kWidth <= cols; j += kWidth) {
    best = xsimd::max(best, Batch<Arch>::load_unaligned(x + j));
  }
  alignas(64) float lanes[kWidth];
  best.store_aligned(lanes);
  float top = lanes[0];
  for (const float lane : lanes) top = lane > top ? lane : top;
  for (; j < cols; ++j) top = x[j] > top ? x[j] : top;
  return top;
}

template <class Arch>
void f32_softmax(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                 std::size_t rows, std::size_t cols) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  constexpr float kLowest = -std::numeric_limits<float>::infinity();
  for (std::size_t r = 0; r < rows; ++r) {
    const float* in = row_of(x, r, x_stride);
    float* out = row_of(y, r, y_stride);
    const float top = row_maximum<Arch>(in, cols);
    // A row of -inf would give -inf - -inf; against 0 it gives e^-inf = 0.
    const Batch<Arch> offset(top == kLowest ? 0.0f : top);
    Batch<Arch> sums(0.0f);
    std::size_t j = 0;
    for (; j + kWidth <= cols; j += kWidth) {
      const Batch<Arch> e = vexp(Batch<Arch>::load_unaligned(in + j) - offset);
      e.store_unaligned(out + j);
      sums += e;
    }
    float sum = xsimd::hadd(sums);
    if (j < cols) {
      store_first<Arch>(out + j, cols - j, vexp(load_first<Arch>(in + j, cols - j) - offset));
      for (; j < cols; ++j) sum += out[j];
    }
    const Batch<Arch> factor(sum == 0.0f ? 0.0f : 1.0f / sum);
    for_columns<Arch>(out, cols, [&](const auto& load) { return load(out) * factor; });
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_SOFTMAX_INL_H_
