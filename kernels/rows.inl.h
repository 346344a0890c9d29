// Kernels that move or join rows: copy, mean over rows, gather from a table, patches of an image.
#ifndef GESTUS_KERNELS_ROWS_INL_H_
#define GESTUS_KERNELS_ROWS_INL_H_

#include "kernels/columns.inl.h"
#include "kernels/kernels.h"

namespace gestus::kernels {
namespace {

template <class Arch>
void f32_copy_rows(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                   std::size_t rows, std::size_t cols) {
  for (std::size_t r = 0; r < rows; ++r) {
    const float* in = row_of(x, r, x_stride);
    for_columns<Arch>(row_of(y, r, y_stride), cols, [&](const auto& load) { return load(in); });
  }
}

template <class Arch>
void f32_mean_rows(float* y, const float* x, std::ptrdiff_t x_stride, std::size_t rows,
                   std::size_t cols) {
  const Batch<Arch> count(static_cast<float>(rows));
  for_columns<Arch>(y, cols, [&](const auto& load) {
    Batch<Arch> sum(0.0f);
    for (std::size_t r = 0; r < rows; ++r) sum += load(row_of(x, r, x_stride));
    return sum / count;
  });
}

template <class Arch>
void f32_gather(float* y, std::ptrdiff_t y_stride, const float* table, std::ptrdiff_t table_stride,
                const std::int32_t* ids, std::size_t n, std::size_t cols, std::size_t vocabulary,
                float scale) {
  const Batch<Arch> factor(scale);
  for (std::size_t i = 0; i < n; ++i) {
    float* out = row_of(y, i, y_stride);
    const bool known = ids[i] >= 0 && static_cast<std::size_t>(ids[i]) < vocabulary;
    if (known) {
      const float* in = row_of(table, static_cast<std::size_t>(ids[i]), table_stride);
      for_columns<Arch>(out, cols, [&](const auto& load) { return factor * load(in); });
    } else {
      for_columns<Arch>(out, cols, [&](const auto&) { return Batch<Arch>(0.0f); });
    }
  }
}

// Strided copies of a few thousand elements per second of speech: not worth vectors.
template <class Arch>
void f32_patches(const PatchArgs& p) {
  for (std::size_t patch = 0; patch < p.ph * p.pw; ++patch) {
    const float* corner = row_of(p.image, patch / p.pw * p.step_h, p.stride_h);
    corner = row_of(corner, patch % p.pw * p.step_w, p.stride_w);
    float* out = row_of(p.out, patch, p.out_stride);
    for (std::size_t i = 0; i < p.kh; ++i) {
      const float* line = row_of(corner, i, p.stride_h);
      for (std::size_t j = 0; j < p.kw; ++j) *out++ = *row_of(line, j, p.stride_w);
    }
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_ROWS_INL_H_
