// Scaled dot-product attention of one head.  Keys come in tiles of kKeyTile; a tile's keys are
// transposed into scratch once and serve every query row of the call.  For each few query rows:
// scores in a buffer on the stack, running softmax (Milakov & Gimelshein 2018), then the weighted
// values on top of what `out` holds.  Tiles of keys are cut from key 0 on and every sum is one
// chain in ascending order, so a row's bits do not depend on how rows are divided between calls.
#ifndef GESTUS_KERNELS_ATTENTION_INL_H_
#define GESTUS_KERNELS_ATTENTION_INL_H_

#include <cstddef>
#include <limits>

#include "kernels/gemm_pack.inl.h"
#include "kernels/gemm_tile.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

constexpr std::size_t kKeyTile = 64;
// Off a power of two, so that the rows of the transposed keys spread over the sets of the L1 cache.
constexpr std::ptrdiff_t kKeyStride = kKeyTile + 16;
constexpr float kMinusInfinity = -std::numeric_limits<float>::infinity();

/// Columns that a tile of R rows takes at a time: one row alone needs more of them to keep the
/// multiply-add units busy.
template <class Arch, std::size_t R>
constexpr std::size_t kAttentionVectors =
    R > 1                              ? GemmTile<Arch>::kVectors
    : 8 < kKeyTile / Batch<Arch>::size ? 8
                                       : kKeyTile / Batch<Arch>::size;

/// What stays the same while the query rows pass one tile of keys.
struct KeyTile {
  std::size_t begin, count;  // keys [begin, begin + count)
  const float* keys;         // (head_dim, kKeyStride) transposed
  const float* v;            // (count, value_dim), first row of the tile
  const float* v_rest;       // (count, width of a vector): columns beyond the last whole vector
  float* top;                // (rows) running maximum
  float* sum;                // (rows) running sum
};

/// Keys of the tile that row `row` may see; they are its first ones.
GESTUS_INLINE std::size_t visible(const AttentionArgs& args, const KeyTile& tile, std::size_t row) {
  if (!args.causal) return tile.count;
  const std::size_t end = args.first_row + row + 1;
  if (end <= tile.begin) return 0;
  return end - tile.begin < tile.count ? end - tile.begin : tile.count;
}

/// scores (R, columns) = scale * q * keys for V vectors of columns from `column` on.
template <class Arch, std::size_t R, std::size_t V>
GESTUS_INLINE void score_block(float* scores, const AttentionArgs& args, const KeyTile& tile,
                               std::size_t row, std::size_t column) {
  TileSum<Arch, R, V> sum;
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) sum.v[r][v] = Batch<Arch>(0.0f);
  }
  tile_multiply<Arch, R, V, false>(sum, args.q + row_offset(row, args.q_stride), args.q_stride,
                                   tile.keys + column, kKeyStride, args.head_dim, {});
  const Batch<Arch> scale(args.scale);
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) {
      (sum.v[r][v] * scale).store_aligned(scores + r * kKeyTile + column + v * Batch<Arch>::size);
    }
  }
}

/// The largest lane.
template <class Arch>
GESTUS_INLINE float largest(const Batch<Arch>& x) {
#if defined(__AVX512F__)
  if constexpr (Batch<Arch>::size == 16) return _mm512_reduce_max_ps(x);
#endif
#if defined(__AVX__)
  if constexpr (Batch<Arch>::size == 8) {
    const __m128 four = _mm_max_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    return largest<xsimd::sse2>(Batch<xsimd::sse2>(four));
  }
#endif
#if defined(__SSE2__)
  if constexpr (Batch<Arch>::size == 4) {
    const __m128 two = _mm_max_ps(x, _mm_movehl_ps(x, x));
    return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
  }
#elif defined(__aarch64__)
  return vmaxvq_f32(x);
#endif
}

/// Turns one row of scores into weights e^(score - maximum) and brings the row's running maximum
/// and sum up to date.  Returns the factor for what was summed under the old maximum.
template <class Arch>
GESTUS_INLINE float weigh_row(float* scores, const AttentionArgs& args, const KeyTile& tile,
                              std::size_t row, std::size_t columns) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const std::size_t seen = visible(args, tile, row);
  if (args.key_bias) {
    const float* bias = args.key_bias + tile.begin;
    for (std::size_t j = 0; j < seen; ++j) scores[j] += bias[j];
  }
  for (std::size_t j = seen; j < columns; ++j) scores[j] = kMinusInfinity;
  Batch<Arch> best(tile.top[row]);
  for (std::size_t j = 0; j < columns; j += kWidth) {
    best = xsimd::max(best, Batch<Arch>::load_aligned(scores + j));
  }
  const float old_top = tile.top[row], top = largest<Arch>(best);
  // While everything is masked the maximum is -inf; against 0 the weights are e^-inf = 0.
  const Batch<Arch> shift(top == kMinusInfinity ? 0.0f : top);
  Batch<Arch> sum(0.0f);
  for (std::size_t j = 0; j < columns; j += kWidth) {
    const Batch<Arch> weight = vexp(Batch<Arch>::load_aligned(scores + j) - shift);
    weight.store_aligned(scores + j);
    sum += weight;
  }
  float factor = 1.0f;
  if (top != old_top) factor = vexp(Batch<Arch>(old_top) - shift).get(0);
  tile.top[row] = top;
  tile.sum[row] = tile.sum[row] * factor + xsimd::hadd(sum);
  return factor;
}

/// out (R, V vectors) = factor * out + weights * v; with `rest` only that many columns are in out.
template <class Arch, std::size_t R, std::size_t V, bool kWhole>
GESTUS_INLINE void value_block(float* out, std::ptrdiff_t out_stride, const float* weights,
                               const float (&factors)[R], const float* v, std::ptrdiff_t v_stride,
                               std::size_t keys, bool first, std::size_t rest) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const auto left = [rest](std::size_t vector) {
    return rest > vector * kWidth
               ? (rest - vector * kWidth < kWidth ? rest - vector * kWidth : kWidth)
               : 0;
  };
  TileSum<Arch, R, V> sum;
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < V; ++i) {
      const float* start = out + row_offset(r, out_stride) + i * kWidth;
      sum.v[r][i] = Batch<Arch>(0.0f);
      if (first) continue;
      sum.v[r][i] = kWhole ? Batch<Arch>::load_unaligned(start) : load_first<Arch>(start, left(i));
      sum.v[r][i] *= Batch<Arch>(factors[r]);
    }
  }
  tile_multiply<Arch, R, V, false>(sum, weights, kKeyTile, v, v_stride, keys, {});
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < V; ++i) {
      float* start = out + row_offset(r, out_stride) + i * kWidth;
      if constexpr (kWhole) {
        sum.v[r][i].store_unaligned(start);
      } else {
        store_first<Arch>(start, left(i), sum.v[r][i]);
      }
    }
  }
}

/// Query rows [row, row + R) against one tile of keys.
template <class Arch, std::size_t R>
[[gnu::noinline]] void attend_rows(const AttentionArgs& args, const KeyTile& tile,
                                   std::size_t row) {
  constexpr std::size_t kWide = kAttentionVectors<Arch, R>,
                        kWideColumns = kWide * Batch<Arch>::size;
  constexpr std::size_t kVectors = GemmTile<Arch>::kVectors, kN = GemmTile<Arch>::kColumns;
  alignas(64) float weights[R * kKeyTile];
  const std::size_t keys = visible(args, tile, row + R - 1);
  std::size_t columns = 0;
  for (; columns + kWideColumns <= kKeyTile && columns + kWideColumns - kN < keys;
       columns += kWideColumns) {
    score_block<Arch, R, kWide>(weights, args, tile, row, columns);
  }
  for (; columns < keys; columns += kN) {
    score_block<Arch, R, kVectors>(weights, args, tile, row, columns);
  }
  float factors[R];
  for (std::size_t r = 0; r < R; ++r) {
    factors[r] = weigh_row<Arch>(weights + r * kKeyTile, args, tile, row + r, columns);
  }
  const bool first = tile.begin == 0;
  float* out = args.out + row_offset(row, args.out_stride);
  std::size_t c = 0;
  for (; c + kWideColumns <= args.value_dim; c += kWideColumns) {
    value_block<Arch, R, kWide, true>(out + c, args.out_stride, weights, factors, tile.v + c,
                                      args.v_stride, keys, first, 0);
  }
  for (; c + kN <= args.value_dim; c += kN) {
    value_block<Arch, R, kVectors, true>(out + c, args.out_stride, weights, factors, tile.v + c,
                                         args.v_stride, keys, first, 0);
  }
  constexpr std::size_t kWidth = Batch<Arch>::size;
  for (; c + kWidth <= args.value_dim; c += kWidth) {
    value_block<Arch, R, 1, true>(out + c, args.out_stride, weights, factors, tile.v + c,
                                  args.v_stride, keys, first, 0);
  }
  if (c < args.value_dim) {
    value_block<Arch, R, 1, false>(out + c, args.out_stride, weights, factors, tile.v_rest, kWidth,
                                   keys, first, args.value_dim - c);
  }
}

/// out row /= sum of its weights; zeros when all keys were masked.
template <class Arch>
GESTUS_INLINE void normalise_row(float* out, std::size_t value_dim, float sum) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const Batch<Arch> factor(sum > 0.0f || sum != sum ? 1.0f / sum : 0.0f);
  // + 0 turns -0 into +0: which of them a masked key leaves depends on the tile that it falls into.
  const Batch<Arch> zero(0.0f);
  std::size_t c = 0;
  for (; c + kWidth <= value_dim; c += kWidth) {
    (Batch<Arch>::load_unaligned(out + c) * factor + zero).store_unaligned(out + c);
  }
  for (; c < value_dim; ++c) out[c] = out[c] * factor.get(0) + 0.0f;
}

template <class Arch>
std::size_t f32_attention_scratch(std::size_t rows, std::size_t /*keys*/, std::size_t head_dim,
                                  std::size_t /*value_dim*/) {
  return head_dim * static_cast<std::size_t>(kKeyStride) + kKeyTile * Batch<Arch>::size + 2 * rows;
}

template <class Arch>
void f32_attention(const AttentionArgs& args) {
  using Tile = GemmTile<Arch>;
  float* keys = args.scratch;
  float* v_rest = keys + row_offset(args.head_dim, kKeyStride);
  float* top = v_rest + kKeyTile * Batch<Arch>::size;
  float* sum = top + args.rows;
  for (std::size_t r = 0; r < args.rows; ++r) {
    top[r] = kMinusInfinity;
    sum[r] = 0.0f;
    for (std::size_t c = 0; args.keys == 0 && c < args.value_dim; ++c) {
      args.out[row_offset(r, args.out_stride) + static_cast<std::ptrdiff_t>(c)] = 0.0f;
    }
  }
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const std::size_t rest = args.value_dim % kWidth;
  std::size_t end = args.keys;
  if (args.causal && args.first_row + args.rows < end) end = args.first_row + args.rows;
  for (std::size_t begin = 0; begin < end; begin += kKeyTile) {
    const std::size_t count = end - begin < kKeyTile ? end - begin : kKeyTile;
    const std::size_t padded = (count + Tile::kColumns - 1) / Tile::kColumns * Tile::kColumns;
    transpose_padded(keys, kKeyStride, args.k + row_offset(begin, args.k_stride), args.k_stride,
                     count, padded, args.head_dim);
    const float* v = args.v + row_offset(begin, args.v_stride);
    for (std::size_t j = 0; j < count && rest > 0; ++j) {
      const float* source = v + row_offset(j, args.v_stride) + (args.value_dim - rest);
      for (std::size_t c = 0; c < kWidth; ++c) {
        v_rest[j * kWidth + c] = c < rest ? source[c] : 0.0f;
      }
    }
    const KeyTile tile{begin, count, keys, v, v_rest, top, sum};
    std::size_t row = 0;
    if (args.causal && begin > args.first_row) row = begin - args.first_row;
    while (row < args.rows) {
      const std::size_t rows = next_tile_rows<Arch>(args.rows - row);
      with_rows<Tile::kRows>(rows, [&](auto r) { attend_rows<Arch, r()>(args, tile, row); });
      row += rows;
    }
  }
  for (std::size_t r = 0; r < args.rows; ++r) {
    normalise_row<Arch>(args.out + row_offset(r, args.out_stride), args.value_dim, sum[r]);
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_ATTENTION_INL_H_
