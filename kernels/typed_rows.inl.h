// Rows of a made ready for the dot products of a type: rounded to bf16, or quantised with a scale
// of their own; and weights packed in groups of k.
#ifndef GESTUS_KERNELS_TYPED_ROWS_INL_H_
#define GESTUS_KERNELS_TYPED_ROWS_INL_H_

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "kernels/dots.inl.h"
#include "kernels/gemm_pack.inl.h"

namespace gestus::kernels {
namespace {

constexpr std::size_t kLine = 64;
// Rows that are prepared at once: a block of them stays in the L2 cache.  A whole number of AMX's
// tiles.
constexpr std::size_t kRowBlock = 96;

constexpr std::size_t round_up(std::size_t n, std::size_t step) {
  return (n + step - 1) / step * step;
}

/// Rows as the tiles read them: `stride` elements apart.
template <class Dot>
struct TypedRows {
  const typename Dot::Row* data;
  std::ptrdiff_t stride;
  const float* scales;  // of the rows; null for bf16
};

/// Bytes from one prepared row to the next: whole cache lines, an odd number of them, so that the
/// rows of a tile do not meet in one set of the L1 cache.
template <class Dot>
constexpr std::size_t row_bytes(std::size_t k) {
  if constexpr (Dot::kPrepared) {
    const std::size_t lines = round_up(k * Dot::kElementBytes, kLine) / kLine;
    return (lines | 1) * kLine;
  }
  return 0;
}

template <class Dot>
std::size_t typed_scratch(std::size_t m, std::size_t k) {
  if constexpr (!Dot::kPrepared) return 0;
  // Tiles of AMX read 16 rows or 32 at once.
  const std::size_t rows = round_up(m < kRowBlock ? m : kRowBlock, m == 1 ? 1 : 32);
  return kRowBlock * sizeof(float) + rows * row_bytes<Dot>(k);
}

/// The largest |x| of a row, as bits: NaN is above infinity, and infinity above all numbers.
template <class Arch>
GESTUS_INLINE std::int32_t largest_bits(const float* x, std::size_t k) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const Ints<Arch> magnitude(0x7fffffff);
  Ints<Arch> top(0);
  std::size_t i = 0;
  for (; i + kWidth <= k; i += kWidth) {
    top = xsimd::max(
        top, xsimd::bitwise_cast<Ints<Arch>>(Batch<Arch>::load_unaligned(x + i)) & magnitude);
  }
  if (i < k)
    top = xsimd::max(top,
                     xsimd::bitwise_cast<Ints<Arch>>(load_first<Arch>(x + i, k - i)) & magnitude);
  alignas(64) std::int32_t lanes[kWidth];
  top.store_aligned(lanes);
  std::int32_t largest = 0;
  for (const std::int32_t lane : lanes) largest = lane > largest ? lane : largest;
  return largest;
}

// Rows whose largest value is below count as zero: 127 / largest must be finite.
constexpr float kSmallestRow = 0x1p-100f;

/// q = round(x * 127 / largest); returns the scale, NaN where the row is not finite.
template <class Dot>
GESTUS_INLINE float quantise_row(std::byte* out, const float* x, std::size_t k) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size;
  constexpr std::int32_t kInfinity = 0x7f800000;
  const std::int32_t bits = largest_bits<Arch>(x, k);
  const float largest = std::bit_cast<float>(bits);
  const bool finite = bits < kInfinity, zero = finite && largest < kSmallestRow;
  const float factor = finite && !zero ? 127.0f / largest : 0.0f;
  // Adding 1.5 * 2^23 rounds to an integer, ties to even, and leaves it in the low bits.
  const Batch<Arch> by(factor), shifter(12582912.0f);
  const Ints<Arch> base = xsimd::bitwise_cast<Ints<Arch>>(shifter);
  const Ints<Arch> keep(finite ? -1 : 0);  // inf * 0 is no integer
  std::size_t i = 0;
  for (; i + kWidth <= k; i += kWidth, out += kWidth * Dot::kElementBytes) {
    const Batch<Arch> y = Batch<Arch>::load_unaligned(x + i) * by + shifter;
    Dot::store_row(out, (xsimd::bitwise_cast<Ints<Arch>>(y) - base) & keep);
  }
  if (i < k) {
    const Batch<Arch> y = load_first<Arch>(x + i, k - i) * by + shifter;
    Dot::store_row(out, (xsimd::bitwise_cast<Ints<Arch>>(y) - base) & keep);
  }
  if (!finite) return std::numeric_limits<float>::quiet_NaN();
  return zero ? 0.0f : largest / 127.0f;
}

template <class Dot>
GESTUS_INLINE void round_row(std::byte* out, const float* x, std::size_t k) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size;
  std::size_t i = 0;
  for (; i + kWidth <= k; i += kWidth, out += kWidth * Dot::kElementBytes) {
    Dot::store_row(out, Batch<Arch>::load_unaligned(x + i));
  }
  if (i < k) Dot::store_row(out, load_first<Arch>(x + i, k - i));
}

/// The rows of a for the dot products, in `scratch` where they are not used as they are.  Bytes of
/// a row's last cache line that no value takes are zero.
template <class Dot>
GESTUS_INLINE TypedRows<Dot> prepare_rows(void* scratch, const float* a, std::ptrdiff_t a_stride,
                                          std::size_t rows, std::size_t k) {
  if constexpr (!Dot::kPrepared) {
    return {a, a_stride, nullptr};
  } else {
    constexpr bool kQuantised = Dot::kTrailerBytes != 0;
    auto* scales = static_cast<float*>(scratch);
    std::byte* const start = static_cast<std::byte*>(scratch) + kRowBlock * sizeof(float);
    const std::size_t bytes = row_bytes<Dot>(k);
    for (std::size_t r = 0; r < rows; ++r) {
      std::byte* row = start + r * bytes;
      const std::size_t last = bytes > kLine ? 2 * kLine : kLine;  // the lines k may end in
      std::memset(row + bytes - last, 0, last);
      const float* x = a + row_offset(r, a_stride);
      if constexpr (kQuantised) {
        scales[r] = quantise_row<Dot>(row, x, k);
      } else {
        round_row<Dot>(row, x, k);
      }
    }
    const auto* data = reinterpret_cast<const typename Dot::Row*>(start);
    const auto stride = static_cast<std::ptrdiff_t>(bytes / sizeof(typename Dot::Row));
    return {data, stride, kQuantised ? scales : nullptr};
  }
}

/// Groups of k in a packed panel.
template <class Dot>
constexpr std::size_t packed_groups(std::size_t k) {
  return round_up((k + Dot::kGroup - 1) / Dot::kGroup, Dot::kPadGroups);
}

template <class Dot>
constexpr std::size_t panel_bytes(std::size_t columns, std::size_t k) {
  return columns * (packed_groups<Dot>(k) * Dot::kBytes + Dot::kTrailerBytes);
}

/// Columns [at, at + padded) of a panel of `columns`: rows of w as groups of k, zeros for those
/// that w lacks and behind its last k.
template <class Dot>
void pack_columns(std::byte* panel, std::size_t at, std::size_t columns, const std::byte* w,
                  std::size_t w_stride, std::size_t rows, std::size_t padded, std::size_t k) {
  constexpr std::size_t kElement = Dot::kBytes / Dot::kGroup;
  const std::size_t pitch = columns * Dot::kBytes, full = k / Dot::kGroup;
  std::byte* const out = panel + at * Dot::kBytes;
  std::size_t group = 0;
  if (Dot::kBytes == sizeof(float) && k % Dot::kGroup == 0 && w_stride % sizeof(float) == 0) {
    transpose_padded(reinterpret_cast<float*>(out), static_cast<std::ptrdiff_t>(columns),
                     reinterpret_cast<const float*>(w),
                     static_cast<std::ptrdiff_t>(w_stride / sizeof(float)), rows, padded, full);
    group = full;
  }
  for (; group < packed_groups<Dot>(k); ++group) {
    std::byte* to = out + group * pitch;
    const std::size_t first = group * Dot::kGroup;
    const std::size_t left = first < k ? k - first : 0;
    const std::size_t bytes = (left < Dot::kGroup ? left : Dot::kGroup) * kElement;
    for (std::size_t c = 0; c < padded; ++c, to += Dot::kBytes) {
      std::memset(to, 0, Dot::kBytes);
      const std::byte* from = w + c * w_stride + first * kElement;
      if (c < rows && bytes == Dot::kBytes) {
        std::memcpy(to, from, Dot::kBytes);  // of a size that the compiler knows
      } else if (c < rows) {
        std::memcpy(to, from, bytes);
      }
    }
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_TYPED_ROWS_INL_H_
