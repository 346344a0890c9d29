// Matrix products by tiles (Intel AMX): 32 rows times a panel of 32 columns, four sums of 16 x 16
// in tile registers.  Prepared rows and packed panels of the dot products are the layout that tiles
// want already.
#ifndef GESTUS_KERNELS_AMX_INL_H_
#define GESTUS_KERNELS_AMX_INL_H_

#include "kernels/dots_avx512.inl.h"
#include "kernels/typed_gemm.inl.h"

namespace gestus::kernels {
namespace {

constexpr std::size_t kTileRows = 16, kTileBytes = 64;

/// What LDTILECFG reads: eight tiles of 16 rows of 64 bytes.
struct alignas(64) TileConfig {
  std::uint8_t palette = 1, start = 0, reserved[14] = {};
  std::uint16_t bytes[16] = {};
  std::uint8_t rows[16] = {};
};

// Tiles 0 to 3 are sums (rows 0 and 1 of tiles by columns 0 and 1), 4 and 5 rows, 6 and 7 weights.
// A macro, because GCC's intrinsics are macros that want numerals.
#define GESTUS_TILE_DOT(sum, rows, weights) \
  if constexpr (Dot::kTrailerBytes != 0) {  \
    _tile_dpbusd(sum, rows, weights);       \
  } else {                                  \
    _tile_dpbf16ps(sum, rows, weights);     \
  }

/// sums (kTall ? 32 : 16, 32) = rows * panel; the next panel's lines from `ahead` on, `lines` for
/// every 16 groups, are asked for.
template <class Dot, bool kTall>
GESTUS_INLINE void tile_block(std::int32_t* sums, const typename Dot::Row* rows,
                              std::ptrdiff_t stride, const std::byte* panel, std::size_t groups,
                              const std::byte* ahead, std::size_t lines) {
  constexpr std::size_t kPitch = 2 * kTileBytes;
  const auto row_bytes = static_cast<std::size_t>(stride) * sizeof(typename Dot::Row);
  _tile_zero(0);
  _tile_zero(1);
  if constexpr (kTall) {
    _tile_zero(2);
    _tile_zero(3);
  }
  const auto* a = reinterpret_cast<const std::byte*>(rows);
  auto line = reinterpret_cast<std::uintptr_t>(ahead);
  for (std::size_t g = 0; g < groups; g += kAmxGroups) {
    for (std::size_t n = 0; n < lines; ++n) prefetch(line + n * kLine);
    line += kAmxGroups * kPitch;
    _tile_loadd(4, a, row_bytes);
    _tile_loadd(6, panel, kPitch);
    GESTUS_TILE_DOT(0, 4, 6)
    _tile_loadd(7, panel + kTileBytes, kPitch);
    GESTUS_TILE_DOT(1, 4, 7)
    if constexpr (kTall) {
      _tile_loadd(5, a + kTileRows * row_bytes, row_bytes);
      GESTUS_TILE_DOT(2, 5, 6)
      GESTUS_TILE_DOT(3, 5, 7)
    }
    a += kTileBytes;
    panel += kAmxGroups * kPitch;
  }
  _tile_stored(0, sums, kPitch);
  _tile_stored(1, sums + kTileRows, kPitch);
  if constexpr (kTall) {
    _tile_stored(2, sums + 2 * kTileRows * kTileRows, kPitch);
    _tile_stored(3, sums + 2 * kTileRows * kTileRows + kTileRows, kPitch);
  }
}

/// out (rows, columns) from the sums of a block; `scales` of its rows, or null.
template <class Dot>
GESTUS_INLINE void store_block(float* out, std::ptrdiff_t out_stride, const std::int32_t* sums,
                               std::size_t rows, std::size_t columns, const float* scales,
                               const std::byte* trailer) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size, kColumns = 2 * kWidth;
  for (std::size_t r = 0; r < rows; ++r, sums += kColumns, out += out_stride) {
    const float scale = scales != nullptr ? scales[r] : 1.0f;
    alignas(64) float narrow[kColumns];
    float* to = columns == kColumns ? out : narrow;
#pragma GCC unroll 2
    for (std::size_t v = 0; v < 2; ++v) {
      const Ints<Arch> bits = Ints<Arch>::load_aligned(sums + v * kWidth);
      typename Dot::Sum sum;
      if constexpr (Dot::kTrailerBytes != 0) {
        sum = bits;
      } else {
        sum = xsimd::bitwise_cast<Batch<Arch>>(bits);
      }
      Dot::result(sum, scale, trailer + v * kWidth * sizeof(float), kColumns)
          .store_unaligned(to + v * kWidth);
    }
    if (columns < kColumns) std::memcpy(out, narrow, columns * sizeof(float));
  }
}

template <class Dot>
void amx_gemm(const GemmArgs& args) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kN = kGemmBlockN<Arch>, kBlock = 2 * kTileRows;
  static_assert(kN * Dot::kBytes == 2 * kTileBytes && kRowBlock % kBlock == 0);
  if (args.m == 1) return typed_gemv<Dot>(args);  // whose scratch is that of one row
  TileConfig config;
  for (int tile = 0; tile < 8; ++tile)
    config.rows[tile] = kTileRows, config.bytes[tile] = kTileBytes;
  _tile_loadconfig(&config);
  const std::size_t groups = packed_groups<Dot>(args.k), bytes = panel_bytes<Dot>(kN, args.k);
  const auto* packed = static_cast<const std::byte*>(args.packed);
  alignas(64) std::int32_t sums[kBlock * kN];
  for (std::size_t m = 0; m < args.m; m += kRowBlock) {
    const std::size_t rows = args.m - m < kRowBlock ? args.m - m : kRowBlock;
    const TypedRows<Dot> from = prepare_rows<Dot>(
        args.scratch, args.a + row_offset(m, args.a_stride), args.a_stride, rows, args.k);
    asm volatile("" ::: "memory");  // GCC 12's tile loads do not say that they read memory
    const std::size_t lines = kBlock * kBlock / round_up(rows, kBlock);
    for (std::size_t column = args.n_begin; column < args.n_end; column += kN) {
      const std::size_t left = args.n_end - column, columns = left < kN ? left : kN;
      const std::byte* panel = packed + column / kN * bytes;
      const std::byte* next = left <= kN ? packed + args.n_begin / kN * bytes : panel + bytes;
      for (std::size_t r = 0; r < rows; r += kBlock) {
        const std::size_t count = rows - r < kBlock ? rows - r : kBlock;
        const auto* row = from.data + row_offset(r, from.stride);
        const std::byte* ahead = next + r / kBlock * lines * kLine;
        if (count > kTileRows) {
          tile_block<Dot, true>(sums, row, from.stride, panel, groups, ahead, lines);
        } else {
          tile_block<Dot, false>(sums, row, from.stride, panel, groups, ahead, lines);
        }
        float* out = args.out + row_offset(m + r, args.out_stride) + column;
        const float* scales = from.scales != nullptr ? from.scales + r : nullptr;
        store_block<Dot>(out, args.out_stride, sums, count, columns, scales,
                         panel + groups * 2 * kTileBytes);
        finish<Arch>(out, args.out_stride, count, columns, args.epilogue, m + r, column);
      }
    }
  }
  _tile_release();
}

#undef GESTUS_TILE_DOT

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_AMX_INL_H_
