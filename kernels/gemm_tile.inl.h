// The register tile that the matrix product and attention share: R rows of a times V vectors of
// columns of b, one chain of multiply-adds per element in ascending k.  The chain is the same for
// every R and V, so an element's bits do not depend on the tile that it fell into.
#ifndef GESTUS_KERNELS_GEMM_TILE_INL_H_
#define GESTUS_KERNELS_GEMM_TILE_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "kernels/math.inl.h"

// For the bodies of kernels: a call inside an inner loop would spill every vector register.
#define GESTUS_INLINE [[gnu::always_inline]] inline

namespace gestus::kernels {
namespace {

template <class Arch>
using Batch = xsimd::batch<float, Arch>;

/// Shape of the register tile: as many accumulators as the register file holds beside a row of b
/// and one element of a.  AVX2: 6 x 2 of 16 registers; AVX-512: 14 x 2 of 32; NEON, whose vectors
/// are short: 6 x 4 of 32.  SSE2 multiplies in place and has no fused multiply-add, so each product
/// takes a copy: it is measured to be fastest with few rows, 2 x 4.
template <class Arch>
struct GemmTile {
  static constexpr std::size_t kWidth = Batch<Arch>::size;
#if defined(__aarch64__)
  static constexpr std::size_t kRows = 6, kVectors = 4;
#else
  static constexpr std::size_t kRows = kWidth == 16 ? 14 : kWidth == 8 ? 6 : 2;
  static constexpr std::size_t kVectors = kWidth == 4 ? 4 : 2;
#endif
  static constexpr std::size_t kColumns = kVectors * kWidth;
};

/// Accumulators of a tile of R rows and V vectors of columns.
template <class Arch, std::size_t R, std::size_t V>
struct TileSum {
  Batch<Arch> v[R][V];
};

GESTUS_INLINE std::ptrdiff_t row_offset(std::size_t row, std::ptrdiff_t stride) {
  return static_cast<std::ptrdiff_t>(row) * stride;
}

/// The first `count` floats at p and zeros above: a load that does not read beyond its row.
template <class Arch>
GESTUS_INLINE Batch<Arch> load_first(const float* p, std::size_t count) {
  alignas(64) float lanes[Batch<Arch>::size] = {};
  for (std::size_t i = 0; i < count; ++i) lanes[i] = p[i];
  return Batch<Arch>::load_aligned(lanes);
}

template <class Arch>
GESTUS_INLINE void store_first(float* p, std::size_t count, const Batch<Arch>& x) {
  alignas(64) float lanes[Batch<Arch>::size];
  x.store_aligned(lanes);
  for (std::size_t i = 0; i < count; ++i) p[i] = lanes[i];
}

/// Asks for the cache line at an address, which may lie behind the end of an array.
GESTUS_INLINE void prefetch(std::uintptr_t address) {
  __builtin_prefetch(reinterpret_cast<const void*>(address));
}

/// Says that x is still needed here.  Without it GCC sees an operand of a multiply-add die, puts
/// the sum into that register and pays with moves and spills of the whole tile at the end of the
/// loop.
template <class Arch>
GESTUS_INLINE void keep_alive(const Batch<Arch>& x) {
#if defined(__x86_64__)
  if constexpr (Batch<Arch>::size > 4) asm volatile("" ::"v"(x.data));  // no such choice in SSE2
#elif defined(__aarch64__)
  asm volatile("" ::"w"(x.data));
#endif
  (void)x;
}

/// sum[r][:] += rows[r][k] * b[:]
template <class Arch, std::size_t R, std::size_t V>
GESTUS_INLINE void tile_step(TileSum<Arch, R, V>& sum, const float* const (&rows)[R], std::size_t k,
                             const float* b) {
  Batch<Arch> columns[V];
#pragma GCC unroll 8
  for (std::size_t v = 0; v < V; ++v) {
    columns[v] = Batch<Arch>::load_unaligned(b + v * Batch<Arch>::size);
  }
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    const Batch<Arch> x(rows[r][k]);
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) {
      sum.v[r][v] = multiply_add(x, columns[v], sum.v[r][v]);
    }
    keep_alive<Arch>(x);
  }
  if constexpr (R > 1) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) keep_alive<Arch>(columns[v]);
  }
}

// Sanitizers instrument every load: unrolled, the tiles would take minutes to compile.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kTileUnroll = 1;
#else
constexpr std::size_t kTileUnroll = 8;
#endif

/// Cache lines that a tile asks for while it computes: `lines` in every kTileUnroll steps.
struct Ahead {
  const void* from = nullptr;
  std::size_t lines = 0;
};

/// sum += a (R, k) * b (k, V vectors), rows of b `b_stride` apart.
template <class Arch, std::size_t R, std::size_t V, bool kAhead>
GESTUS_INLINE void tile_multiply(TileSum<Arch, R, V>& sum, const float* a, std::ptrdiff_t a_stride,
                                 const float* b, std::ptrdiff_t b_stride, std::size_t k,
                                 const Ahead& ahead) {
  const float* rows[R];
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) rows[r] = a + row_offset(r, a_stride);
  std::uintptr_t line = reinterpret_cast<std::uintptr_t>(ahead.from);
  std::size_t i = 0;
  for (; i + kTileUnroll <= k; i += kTileUnroll) {
    if constexpr (kAhead) {
      for (std::size_t n = ahead.lines; n > 0; --n, line += 64) prefetch(line);
    }
#pragma GCC unroll 8
    for (std::size_t u = 0; u < kTileUnroll; ++u) {
      tile_step<Arch, R, V>(sum, rows, i + u, b + row_offset(u, b_stride));
    }
    b += row_offset(kTileUnroll, b_stride);
  }
  for (; i < k; ++i, b += b_stride) tile_step<Arch, R, V>(sum, rows, i, b);
}

/// Rows of the next tile when `left` rows remain: the last two tiles share their rows evenly, since
/// a tile of two rows alone takes as long as one of four.
template <class Tile>
GESTUS_INLINE std::size_t next_tile_rows(std::size_t left) {
  constexpr std::size_t kRows = Tile::kRows;
  if (left >= 2 * kRows || left == kRows) return kRows;
  return left > kRows ? (left + 1) / 2 : left;
}

/// How many tiles `rows` rows are cut into.
template <class Arch>
GESTUS_INLINE std::size_t tiles_of(std::size_t rows) {
  constexpr std::size_t kRows = GemmTile<Arch>::kRows;
  return (rows + kRows - 1) / kRows;
}

/// The share of each of `tiles` tiles in asking for `lines` lines.
GESTUS_INLINE std::size_t lines_ahead(std::size_t lines, std::size_t tiles) {
  return (lines + tiles - 1) / tiles;
}

/// Calls f with `rows` (1..R) as a compile-time constant.
template <std::size_t R, class F>
GESTUS_INLINE void with_rows(std::size_t rows, const F& f) {
  if constexpr (R > 1) {
    if (rows != R) return with_rows<R - 1>(rows, f);
  }
  f(std::integral_constant<std::size_t, R>{});
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_GEMM_TILE_INL_H_
