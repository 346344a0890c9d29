// Matrix products with bf16 and 8-bit weights.  Packed layout: panels of kGemmBlockN columns, in
// each the groups of k that dots.inl.h describes, then (i8) the columns' scales and corrections.
//
// Loops: blocks of rows, which are prepared once and then stay in the L2 cache; panels; tiles of
// rows.  A tile's sums run over all of k in registers.
#ifndef GESTUS_KERNELS_TYPED_GEMM_INL_H_
#define GESTUS_KERNELS_TYPED_GEMM_INL_H_

#include <cstddef>
#include <cstring>

#include "kernels/gemm.inl.h"
#include "kernels/gemv.inl.h"
#include "kernels/typed_rows.inl.h"

namespace gestus::kernels {
namespace {

// As kTileUnroll.
constexpr std::size_t kDotUnroll = kTileUnroll == 1 ? 1 : 4;

/// out (R, V vectors) = rows (R, k) * panel (k, V vectors)
template <class Dot, std::size_t R, std::size_t V>
[[gnu::noinline]] void dot_tile(float* out, std::ptrdiff_t out_stride, const TypedRows<Dot>& from,
                                std::size_t first_row, const std::byte* panel, std::size_t k,
                                const Ahead& ahead, const TileEnd& end) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size, kPitch = V * kWidth * Dot::kBytes;
  DotSums<Dot, R, V> sums;
  const typename Dot::Row* rows[R];
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    rows[r] = from.data + row_offset(first_row + r, from.stride);
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) sums.v[r][v] = Dot::zero();
  }
  const std::size_t groups = Dot::kPrepared ? (k + Dot::kGroup - 1) / Dot::kGroup : k / Dot::kGroup;
  std::uintptr_t line = reinterpret_cast<std::uintptr_t>(ahead.from);
  const std::byte* w = panel;
  std::size_t g = 0;
  for (; g + kDotUnroll <= groups; g += kDotUnroll) {
    for (std::size_t n = ahead.lines; n > 0; --n, line += kLine) prefetch(line);
#pragma GCC unroll 4
    for (std::size_t u = 0; u < kDotUnroll; ++u, w += kPitch) {
      dot_step<Dot, R, V, 0, Dot::kPhases>(sums, rows, g + u, w);
    }
  }
  for (; g < groups; ++g, w += kPitch) dot_step<Dot, R, V, 0, Dot::kPhases>(sums, rows, g, w);
  // A row that is used as it is has no zeros behind it.
  if (!Dot::kPrepared && k % Dot::kGroup != 0) dot_step<Dot, R, V, 0, 1>(sums, rows, g, w);
  const std::byte* trailer = panel + packed_groups<Dot>(k) * kPitch;
  TileSum<Arch, R, V> result;
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    const float scale = from.scales != nullptr ? from.scales[first_row + r] : 1.0f;
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) {
      result.v[r][v] =
          Dot::result(sums.v[r][v], scale, trailer + v * kWidth * sizeof(float), V * kWidth);
    }
  }
  end_tile<Arch, R, V>(result, end);
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) {
      result.v[r][v].store_unaligned(out + row_offset(r, out_stride) + v * kWidth);
    }
  }
}

/// One panel times one row, k in chains that hide the latency of the instructions.
template <class Dot, std::size_t V, std::size_t kChains>
GESTUS_INLINE void dot_row(typename Dot::Sum (&total)[V], const typename Dot::Row* row,
                           const std::byte* w, std::size_t k) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kPitch = V * Batch<Arch>::size * Dot::kBytes;
  constexpr std::size_t kLines = (kPitch * kChains + kLine - 1) / kLine;
  DotSums<Dot, 1, V> sums[kChains];
#pragma GCC unroll 4
  for (std::size_t u = 0; u < kChains; ++u) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) sums[u].v[0][v] = Dot::zero();
  }
  const typename Dot::Row* const rows[1] = {row};
  const std::size_t groups = Dot::kPrepared ? (k + Dot::kGroup - 1) / Dot::kGroup : k / Dot::kGroup;
  std::size_t g = 0;
  for (; g + kChains <= groups; g += kChains, w += kChains * kPitch) {
    const std::uintptr_t ahead = reinterpret_cast<std::uintptr_t>(w) + kGemvAhead;
#pragma GCC unroll 8
    for (std::size_t line = 0; line < kLines; ++line) prefetch(ahead + line * kLine);
#pragma GCC unroll 4
    for (std::size_t u = 0; u < kChains; ++u) {
      dot_step<Dot, 1, V, 0, Dot::kPhases>(sums[u], rows, g + u, w + u * kPitch);
    }
  }
  for (; g < groups; ++g, w += kPitch) {
    dot_step<Dot, 1, V, 0, Dot::kPhases>(sums[0], rows, g, w);
  }
  if (!Dot::kPrepared && k % Dot::kGroup != 0) dot_step<Dot, 1, V, 0, 1>(sums[0], rows, g, w);
#pragma GCC unroll 8
  for (std::size_t v = 0; v < V; ++v) {
    total[v] = sums[0].v[0][v];
#pragma GCC unroll 4
    for (std::size_t u = 1; u < kChains; ++u) total[v] = Dot::add(total[v], sums[u].v[0][v]);
  }
}

template <class Dot>
std::size_t typed_gemm_packed_size(std::size_t n, std::size_t k) {
  constexpr std::size_t kN = kGemmBlockN<typename Dot::Isa>;
  return round_up(n, kN) / kN * panel_bytes<Dot>(kN, k);
}

/// Behind the scales of a panel: what a row of zeros gives, which is not zero where rows are stored
/// with an offset.
template <class Dot, std::size_t V>
void pack_corrections(std::byte* panel, std::size_t k) {
  if constexpr (Dot::kTrailerBytes != 0) {
    constexpr std::size_t kWidth = Batch<typename Dot::Isa>::size, kColumns = V * kWidth;
    const std::size_t groups = packed_groups<Dot>(k);
    std::byte* corrections = panel + kColumns * (groups * Dot::kBytes + sizeof(float));
    if constexpr (Dot::kZeroRow == 0) {
      std::memset(corrections, 0, kColumns * sizeof(std::int32_t));
      return;
    }
    for (std::size_t v = 0; v < V; ++v) {
      typename Dot::Sum sum = Dot::zero();
      const typename Dot::Row zeros[1] = {Dot::kZeroRow};
      for (std::size_t g = 0; g < groups; ++g) {
        const std::byte* w = panel + (g * kColumns + v * kWidth) * Dot::kBytes;
        sum = Dot::dot(sum, Dot::template broadcast<0>(zeros, 0), Dot::template load<0>(w));
      }
      sum.store_unaligned(reinterpret_cast<std::int32_t*>(corrections) + v * kWidth);
    }
  }
}

/// Scales of `rows` columns, zeros up to `padded`.
template <class Dot>
void pack_scales(std::byte* to, const float* scale, std::size_t rows, std::size_t padded) {
  for (std::size_t c = 0; c < padded; ++c, to += sizeof(float)) {
    const float value = c < rows ? scale[c] : 0.0f;
    std::memcpy(to, &value, sizeof value);
  }
}

template <class Dot>
void typed_gemm_pack(void* packed, const void* w, const float* scale, std::ptrdiff_t w_stride,
                     std::size_t n, std::size_t k) {
  constexpr std::size_t kN = kGemmBlockN<typename Dot::Isa>;
  const std::size_t stride_bytes = static_cast<std::size_t>(w_stride) * Dot::kBytes / Dot::kGroup;
  auto* panel = static_cast<std::byte*>(packed);
  for (std::size_t column = 0; column < n; column += kN, panel += panel_bytes<Dot>(kN, k)) {
    const std::size_t columns = n - column < kN ? n - column : kN;
    pack_columns<Dot>(panel, 0, kN, static_cast<const std::byte*>(w) + column * stride_bytes,
                      stride_bytes, columns, kN, k);
    if constexpr (Dot::kTrailerBytes != 0) {
      pack_scales<Dot>(panel + kN * packed_groups<Dot>(k) * Dot::kBytes, scale + column, columns,
                       kN);
    }
    pack_corrections<Dot, GemmTile<typename Dot::Isa>::kVectors>(panel, k);
  }
}

/// Rows [m_begin, m_end) of the output times one panel; `rows` are those from m_begin on.
template <class Dot>
GESTUS_INLINE void dot_panel(const GemmArgs& args, const TypedRows<Dot>& rows, std::size_t m_begin,
                             std::size_t m_end, std::size_t column, const std::byte* panel,
                             const std::byte* next) {
  using Arch = typename Dot::Isa;
  using Tile = GemmTile<Arch>;
  const std::size_t left = args.n_end - column;
  const std::size_t columns = left < Tile::kColumns ? left : Tile::kColumns;
  Ahead ahead{next, lines_ahead(Tile::kColumns * Dot::kBytes * kDotUnroll / kLine,
                                tiles_of<Arch>(m_end - m_begin))};
  for (std::size_t row = m_begin; row < m_end;) {
    const std::size_t count = next_tile_rows<Tile>(m_end - row);
    float* out = args.out + row_offset(row, args.out_stride) + column;
    if (columns == Tile::kColumns) {
      const TileEnd end(args.epilogue, row, column);
      with_rows<Tile::kRows>(count, [&](auto r) {
        dot_tile<Dot, r(), Tile::kVectors>(out, args.out_stride, rows, row - m_begin, panel, args.k,
                                           ahead, end);
      });
      finish_tile<Arch>(out, args.out_stride, count, columns, args.epilogue, row, column);
    } else {
      alignas(64) float tile[Tile::kRows * Tile::kColumns];
      with_rows<Tile::kRows>(count, [&](auto r) {
        dot_tile<Dot, r(), Tile::kVectors>(tile, Tile::kColumns, rows, row - m_begin, panel, args.k,
                                           ahead, {});
      });
      for (std::size_t r = 0; r < count; ++r) {
        std::memcpy(out + row_offset(r, args.out_stride), tile + r * Tile::kColumns,
                    columns * sizeof(float));
      }
      finish<Arch>(out, args.out_stride, count, columns, args.epilogue, row, column);
    }
    row += count;
    ahead.from = static_cast<const std::byte*>(ahead.from) +
                 packed_groups<Dot>(args.k) / kDotUnroll * ahead.lines * kLine;
  }
}

template <class Dot>
void typed_gemm(const GemmArgs& args) {
  constexpr std::size_t kN = kGemmBlockN<typename Dot::Isa>;
  const std::size_t bytes = panel_bytes<Dot>(kN, args.k);
  const auto* packed = static_cast<const std::byte*>(args.packed);
  for (std::size_t m = 0; m < args.m; m += kRowBlock) {
    const std::size_t m_end = m + kRowBlock < args.m ? m + kRowBlock : args.m;
    const TypedRows<Dot> rows = prepare_rows<Dot>(
        args.scratch, args.a + row_offset(m, args.a_stride), args.a_stride, m_end - m, args.k);
    for (std::size_t column = args.n_begin; column < args.n_end; column += kN) {
      const bool last = args.n_end - column <= kN;
      const std::byte* panel = packed + column / kN * bytes;
      const std::byte* next = last ? packed + args.n_begin / kN * bytes : panel + bytes;
      dot_panel<Dot>(args, rows, m, m_end, column, panel, next);
    }
  }
}

template <class Dot>
void typed_gemv(const GemmArgs& args) {
  using Arch = typename Dot::Isa;
  using Tile = GemmTile<Arch>;
  constexpr std::size_t kN = kGemmBlockN<Arch>, kChains = 4;
  const std::size_t bytes = panel_bytes<Dot>(kN, args.k);
  const TypedRows<Dot> row = prepare_rows<Dot>(args.scratch, args.a, 0, 1, args.k);
  const float scale = row.scales != nullptr ? row.scales[0] : 1.0f;
  for (std::size_t column = args.n_begin; column < args.n_end; column += kN) {
    const std::byte* panel = static_cast<const std::byte*>(args.packed) + column / kN * bytes;
    const std::byte* trailer = panel + kN * packed_groups<Dot>(args.k) * Dot::kBytes;
    typename Dot::Sum total[Tile::kVectors];
    dot_row<Dot, Tile::kVectors, kChains>(total, row.data, panel, args.k);
    const std::size_t left = args.n_end - column, columns = left < kN ? left : kN;
    alignas(64) float tile[kN];
    float* out = args.out + column;
#pragma GCC unroll 8
    for (std::size_t v = 0; v < Tile::kVectors; ++v) {
      const std::byte* behind = trailer + v * Tile::kWidth * sizeof(float);
      Dot::result(total[v], scale, behind, kN)
          .store_unaligned((columns == kN ? out : tile) + v * Tile::kWidth);
    }
    if (columns < kN) std::memcpy(out, tile, columns * sizeof(float));
    finish<Arch>(out, 0, 1, columns, args.epilogue, 0, column);
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_TYPED_GEMM_INL_H_
