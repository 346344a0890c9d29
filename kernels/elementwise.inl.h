// Kernels that work on each element by itself: activation, sum, and scale with shift per column.
#ifndef GESTUS_KERNELS_ELEMENTWISE_INL_H_
#define GESTUS_KERNELS_ELEMENTWISE_INL_H_

#include "kernels/columns.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

template <class Arch>
void f32_activate(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                  std::size_t rows, std::size_t cols, Activation act, float alpha) {
  const Batch<Arch> slope(alpha);
  with_activation(act, [&](auto known) {
    for (std::size_t r = 0; r < rows; ++r) {
      const float* in = row_of(x, r, x_stride);
      for_columns<Arch>(row_of(y, r, y_stride), cols, [&](const auto& load) {
        return apply_activation<decltype(known)::value>(load(in), slope);
      });
    }
  });
}

template <class Arch>
void f32_add(float* y, std::ptrdiff_t y_stride, const float* a, std::ptrdiff_t a_stride,
             const float* b, std::ptrdiff_t b_stride, std::size_t rows, std::size_t cols) {
  for (std::size_t r = 0; r < rows; ++r) {
    const float* left = row_of(a, r, a_stride);
    const float* right = row_of(b, r, b_stride);
    for_columns<Arch>(row_of(y, r, y_stride), cols,
                      [&](const auto& load) { return load(left) + load(right); });
  }
}

template <class Arch>
void f32_affine(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                const float* scale, const float* shift, std::size_t rows, std::size_t cols) {
  for (std::size_t r = 0; r < rows; ++r) {
    const float* in = row_of(x, r, x_stride);
    for_columns<Arch>(row_of(y, r, y_stride), cols, [&](const auto& load) {
      return multiply_add(load(in), load(scale), load(shift));
    });
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_ELEMENTWISE_INL_H_
