// A walk along one row, vector by vector, that neither reads nor writes beyond its end.  Shared by
// the kernels that treat each row by itself.
#ifndef GESTUS_KERNELS_COLUMNS_INL_H_
#define GESTUS_KERNELS_COLUMNS_INL_H_

#include <cstddef>

#include "kernels/gemm_tile.inl.h"

namespace gestus::kernels {
namespace {

/// Row r of a matrix.
template <class T>
GESTUS_INLINE T* row_of(T* p, std::size_t r, std::ptrdiff_t stride) {
  return p + static_cast<std::ptrdiff_t>(r) * stride;
}

/// Loads the current columns of a row.
template <class Arch>
struct FullLoad {
  std::size_t column;
  GESTUS_INLINE Batch<Arch> operator()(const float* row) const {
    return Batch<Arch>::load_unaligned(row + column);
  }
};

/// The same at the end of a row, where `count` columns are left.
template <class Arch>
struct TailLoad {
  std::size_t column, count;
  GESTUS_INLINE Batch<Arch> operator()(const float* row) const {
    return load_first<Arch>(row + column, count);
  }
};

/// y[j] = f(load)[j] for all columns j, where load(row) gives the same columns of any row.
template <class Arch, class F>
GESTUS_INLINE void for_columns(float* y, std::size_t cols, const F& f) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  std::size_t j = 0;
  for (; j + kWidth <= cols; j += kWidth) f(FullLoad<Arch>{j}).store_unaligned(y + j);
  if (j < cols) store_first<Arch>(y + j, cols - j, f(TailLoad<Arch>{j, cols - j}));
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_COLUMNS_INL_H_
