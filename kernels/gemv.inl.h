// Product of one row with packed weights: the weights are read once, as one ascending stream, and
// their memory sets the pace.
#ifndef GESTUS_KERNELS_GEMV_INL_H_
#define GESTUS_KERNELS_GEMV_INL_H_

#include <cstddef>

#include "kernels/gemm.inl.h"
#include "kernels/gemm_tile.inl.h"
#include "kernels/kernels.h"

namespace gestus::kernels {
namespace {

// Bytes between the weights in use and those asked for: far enough to cover the latency of DRAM
// and to carry the stream over the ends of pages, where the hardware's prefetch stops.
constexpr std::size_t kGemvAhead = 2048;

/// out (kColumns) = a (k) * b (k, kColumns), k in kChains interleaved chains that hide the latency
/// of the multiply-add units.
template <class Arch>
GESTUS_INLINE void gemv_panel(float* out, const float* a, const float* b, std::size_t k) {
  using Tile = GemmTile<Arch>;
  constexpr std::size_t kChains = 4;
  constexpr std::size_t kLines = Tile::kColumns * sizeof(float) * kChains / 64;
  Batch<Arch> sum[kChains][Tile::kVectors];
#pragma GCC unroll 4
  for (std::size_t u = 0; u < kChains; ++u) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < Tile::kVectors; ++v) sum[u][v] = Batch<Arch>(0.0f);
  }
  std::size_t i = 0;
  for (; i + kChains <= k; i += kChains, b += kChains * Tile::kColumns) {
    const std::uintptr_t ahead = reinterpret_cast<std::uintptr_t>(b) + kGemvAhead;
#pragma GCC unroll 8
    for (std::size_t line = 0; line < kLines; ++line) prefetch(ahead + line * 64);
#pragma GCC unroll 4
    for (std::size_t u = 0; u < kChains; ++u) {
      const Batch<Arch> x(a[i + u]);
#pragma GCC unroll 8
      for (std::size_t v = 0; v < Tile::kVectors; ++v) {
        const float* columns = b + u * Tile::kColumns + v * Tile::kWidth;
        sum[u][v] = multiply_add(x, Batch<Arch>::load_unaligned(columns), sum[u][v]);
      }
    }
  }
  for (; i < k; ++i, b += Tile::kColumns) {
    const Batch<Arch> x(a[i]);
#pragma GCC unroll 8
    for (std::size_t v = 0; v < Tile::kVectors; ++v) {
      sum[0][v] = multiply_add(x, Batch<Arch>::load_unaligned(b + v * Tile::kWidth), sum[0][v]);
    }
  }
#pragma GCC unroll 8
  for (std::size_t v = 0; v < Tile::kVectors; ++v) {
    const Batch<Arch> total = (sum[0][v] + sum[1][v]) + (sum[2][v] + sum[3][v]);
    total.store_unaligned(out + v * Tile::kWidth);
  }
}

template <class Arch>
void f32_gemv(const GemmArgs& args) {
  constexpr std::size_t kN = kGemmBlockN<Arch>;
  for (std::size_t column = args.n_begin; column < args.n_end; column += kN) {
    const float* b = static_cast<const float*>(args.packed) + column * args.k;
    const std::size_t left = args.n_end - column;
    const std::size_t columns = left < kN ? left : kN;
    float* out = args.out + column;
    if (columns == kN) {
      gemv_panel<Arch>(out, args.a, b, args.k);
    } else {
      alignas(64) float tile[kN];
      gemv_panel<Arch>(tile, args.a, b, args.k);
      for (std::size_t c = 0; c < columns; ++c) out[c] = tile[c];
    }
    finish<Arch>(out, 0, 1, columns, args.epilogue, 0, column);
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_GEMV_INL_H_
