// Matrix product against packed weights.  Packed layout: panels of kGemmBlockN columns, in each
// panel k rows of kGemmBlockN floats, zeros beyond column n: the order in which the tile reads.
//
// Loops: blocks of rows whose slice of a stays in the L2 cache; slices of k; panels; tiles of rows.
// Sums between slices of k rest in `out`, so an element is one chain of multiply-adds over all of k
// (Goto & van de Geijn 2008, without packing a: transformer rows are long and contiguous already).
#ifndef GESTUS_KERNELS_GEMM_INL_H_
#define GESTUS_KERNELS_GEMM_INL_H_

#include <cstddef>

#include "kernels/gemm_pack.inl.h"
#include "kernels/gemm_tile.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

template <class Arch>
constexpr std::size_t kGemmBlockN = GemmTile<Arch>::kColumns;

// A block of a, kBlockM x kBlockK floats, takes 288 KiB: it fits the 512 KiB of a small L2.
constexpr std::size_t kBlockM = 96;
constexpr std::size_t kBlockK = 768;

template <class Arch>
std::size_t f32_gemm_packed_size(std::size_t n, std::size_t k) {
  constexpr std::size_t kN = kGemmBlockN<Arch>;
  return (n + kN - 1) / kN * kN * k;
}

template <class Arch>
void f32_gemm_pack(float* packed, const float* w, std::ptrdiff_t w_stride, std::size_t n,
                   std::size_t k) {
  constexpr std::size_t kN = kGemmBlockN<Arch>;
  for (std::size_t column = 0; column < n; column += kN, packed += kN * k) {
    const std::size_t columns = n - column < kN ? n - column : kN;
    transpose_padded(packed, kN, w + row_offset(column, w_stride), w_stride, columns, kN, k);
  }
}

/// out (rows, columns) = act(out + bias) + residual in place, `row` and `column` telling where in
/// the whole matrix it lies.
template <class Arch, Activation act>
GESTUS_INLINE void finish_rows(float* out, std::ptrdiff_t out_stride, std::size_t rows,
                               std::size_t columns, const Epilogue& epilogue, std::size_t row,
                               std::size_t column) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const Batch<Arch> alpha(epilogue.alpha);
  for (std::size_t r = 0; r < rows; ++r, out += out_stride) {
    const float* residual = epilogue.residual;
    if (residual) residual += row_offset(row + r, epilogue.residual_stride) + column;
    const float* bias = epilogue.bias ? epilogue.bias + column : nullptr;
    std::size_t c = 0;
    for (; c + kWidth <= columns; c += kWidth) {
      Batch<Arch> y = Batch<Arch>::load_unaligned(out + c);
      if (bias) y += Batch<Arch>::load_unaligned(bias + c);
      y = apply_activation<act>(y, alpha);
      if (residual) y += Batch<Arch>::load_unaligned(residual + c);
      y.store_unaligned(out + c);
    }
    if (const std::size_t rest = columns - c) {
      Batch<Arch> y = load_first<Arch>(out + c, rest);
      if (bias) y += load_first<Arch>(bias + c, rest);
      y = apply_activation<act>(y, alpha);
      if (residual) y += load_first<Arch>(residual + c, rest);
      store_first<Arch>(out + c, rest, y);
    }
  }
}

template <class Arch>
[[gnu::noinline]] void finish(float* out, std::ptrdiff_t out_stride, std::size_t rows,
                              std::size_t columns, const Epilogue& epilogue, std::size_t row,
                              std::size_t column) {
  if (!epilogue.bias && !epilogue.residual && epilogue.act == Activation::kNone) return;
  with_activation(epilogue.act, [&](auto act) {
    finish_rows<Arch, act()>(out, out_stride, rows, columns, epilogue, row, column);
  });
}

/// What a tile of sums ends with before it is stored: the parts of an epilogue that need no more
/// registers.
struct TileEnd {
  const float* bias = nullptr;
  const float* residual = nullptr;
  std::ptrdiff_t residual_stride = 0;
  bool relu = false;

  TileEnd() = default;
  TileEnd(const Epilogue& epilogue, std::size_t row, std::size_t column) {
    if (epilogue.bias) bias = epilogue.bias + column;
    if (!holds(epilogue)) return;
    relu = epilogue.act == Activation::kRelu;
    residual_stride = epilogue.residual_stride;
    if (epilogue.residual) residual = epilogue.residual + row_offset(row, residual_stride) + column;
  }

  /// Whether nothing but this is left to do.
  static bool holds(const Epilogue& epilogue) {
    return epilogue.act == Activation::kNone || epilogue.act == Activation::kRelu;
  }
};

/// The rest of an epilogue of which TileEnd is done.
template <class Arch>
GESTUS_INLINE void finish_tile(float* out, std::ptrdiff_t out_stride, std::size_t rows,
                               std::size_t columns, const Epilogue& epilogue, std::size_t row,
                               std::size_t column) {
  if (TileEnd::holds(epilogue)) return;
  Epilogue rest = epilogue;
  rest.bias = nullptr;
  finish<Arch>(out, out_stride, rows, columns, rest, row, column);
}

template <class Arch, std::size_t R, std::size_t V>
GESTUS_INLINE void end_tile(TileSum<Arch, R, V>& sum, const TileEnd& end) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  if (end.bias) {
    Batch<Arch> bias[V];
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v)
      bias[v] = Batch<Arch>::load_unaligned(end.bias + v * kWidth);
#pragma GCC unroll 16
    for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
      for (std::size_t v = 0; v < V; ++v) sum.v[r][v] += bias[v];
    }
  }
  if (end.relu) {
    const Batch<Arch> alpha(0.0f);
#pragma GCC unroll 16
    for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
      for (std::size_t v = 0; v < V; ++v) {
        sum.v[r][v] = apply_activation<Activation::kRelu>(sum.v[r][v], alpha);
      }
    }
  }
  if (end.residual) {
#pragma GCC unroll 16
    for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
      for (std::size_t v = 0; v < V; ++v) {
        sum.v[r][v] += Batch<Arch>::load_unaligned(end.residual +
                                                   row_offset(r, end.residual_stride) + v * kWidth);
      }
    }
  }
}

/// out (R, kColumns) = [out +] a (R, k) * b (k, kColumns), and then `end`
template <class Arch, std::size_t R>
[[gnu::noinline]] void gemm_tile(float* out, std::ptrdiff_t out_stride, const float* a,
                                 std::ptrdiff_t a_stride, const float* b, std::size_t k, bool first,
                                 const Ahead& ahead, const TileEnd& end) {
  using Tile = GemmTile<Arch>;
  TileSum<Arch, R, Tile::kVectors> sum;
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < Tile::kVectors; ++v) {
      const float* start = out + row_offset(r, out_stride) + v * Tile::kWidth;
      sum.v[r][v] = first ? Batch<Arch>(0.0f) : Batch<Arch>::load_unaligned(start);
    }
  }
  tile_multiply<Arch, R, Tile::kVectors, true>(sum, a, a_stride, b, Tile::kColumns, k, ahead);
  end_tile<Arch, R, Tile::kVectors>(sum, end);
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < Tile::kVectors; ++v) {
      sum.v[r][v].store_unaligned(out + row_offset(r, out_stride) + v * Tile::kWidth);
    }
  }
}

/// The same for the first `columns` columns only, by way of a tile on the stack.
template <class Arch>
[[gnu::noinline]] void gemm_tile_narrow(float* out, std::ptrdiff_t out_stride, std::size_t rows,
                                        std::size_t columns, const float* a,
                                        std::ptrdiff_t a_stride, const float* b, std::size_t k,
                                        bool first) {
  using Tile = GemmTile<Arch>;
  alignas(64) float tile[Tile::kRows * Tile::kColumns] = {};
  for (std::size_t r = 0; r < rows && !first; ++r) {
    const float* source = out + row_offset(r, out_stride);
    for (std::size_t c = 0; c < columns; ++c) tile[r * Tile::kColumns + c] = source[c];
  }
  with_rows<Tile::kRows>(rows, [&](auto r) {
    gemm_tile<Arch, r()>(tile, Tile::kColumns, a, a_stride, b, k, first, {}, {});
  });
  for (std::size_t r = 0; r < rows; ++r) {
    float* target = out + row_offset(r, out_stride);
    for (std::size_t c = 0; c < columns; ++c) target[c] = tile[r * Tile::kColumns + c];
  }
}

/// One slice of k of one panel, for rows [m_begin, m_end).
struct GemmSlice {
  std::size_t m_begin, m_end;
  std::size_t k_begin, k;
  std::size_t column, columns;
  const float* next;  // the slice that will be read after this one
};

template <class Arch>
GESTUS_INLINE void gemm_slice(const GemmArgs& args, const GemmSlice& slice) {
  using Tile = GemmTile<Arch>;
  const float* b = static_cast<const float*>(args.packed) + slice.column * args.k +
                   slice.k_begin * Tile::kColumns;
  const bool first = slice.k_begin == 0;
  const bool last = slice.k_begin + slice.k == args.k;
  // The tiles share the lines of the next slice between them.
  constexpr std::size_t kLineFloats = 64 / sizeof(float);
  Ahead ahead{slice.next, lines_ahead(Tile::kColumns * kTileUnroll / kLineFloats,
                                      tiles_of<Arch>(slice.m_end - slice.m_begin))};
  for (std::size_t row = slice.m_begin; row < slice.m_end;) {
    const std::size_t rows = next_tile_rows<Tile>(slice.m_end - row);
    float* out = args.out + row_offset(row, args.out_stride) + slice.column;
    const float* a = args.a + row_offset(row, args.a_stride) + slice.k_begin;
    if (slice.columns == Tile::kColumns) {
      const TileEnd end = last ? TileEnd(args.epilogue, row, slice.column) : TileEnd();
      with_rows<Tile::kRows>(rows, [&](auto r) {
        gemm_tile<Arch, r()>(out, args.out_stride, a, args.a_stride, b, slice.k, first, ahead, end);
      });
      if (last) {
        finish_tile<Arch>(out, args.out_stride, rows, slice.columns, args.epilogue, row,
                          slice.column);
      }
    } else {
      gemm_tile_narrow<Arch>(out, args.out_stride, rows, slice.columns, a, args.a_stride, b,
                             slice.k, first);
      if (last) {
        finish<Arch>(out, args.out_stride, rows, slice.columns, args.epilogue, row, slice.column);
      }
    }
    row += rows;
    ahead.from =
        static_cast<const float*>(ahead.from) + slice.k / kTileUnroll * ahead.lines * kLineFloats;
  }
}

template <class Arch>
void f32_gemm(const GemmArgs& args) {
  constexpr std::size_t kN = kGemmBlockN<Arch>;
  const float* packed = static_cast<const float*>(args.packed);
  for (std::size_t m = 0; m < args.m; m += kBlockM) {
    const std::size_t m_end = m + kBlockM < args.m ? m + kBlockM : args.m;
    std::size_t k = 0;
    do {
      const std::size_t depth = args.k - k < kBlockK ? args.k - k : kBlockK;
      for (std::size_t column = args.n_begin; column < args.n_end; column += kN) {
        const std::size_t left = args.n_end - column;
        const float* next = packed + (column + kN) * args.k + k * kN;
        if (left <= kN) next = packed + args.n_begin * args.k + (k + depth) * kN;
        gemm_slice<Arch>(args, {m, m_end, k, depth, column, left < kN ? left : kN, next});
      }
      k += depth;
    } while (k < args.k);
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_GEMM_INL_H_
