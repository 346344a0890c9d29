// Scaled dot-product attention of one head, by way of a type of dot products (dots.inl.h).  Keys
// and values are packed once a call, as weights are, and serve every query row.  For each few query
// rows: the scores of all keys, a softmax of whole rows, the weighted values in registers.  Every
// sum is one chain in ascending order, so a row's bits do not depend on how rows are divided
// between calls.
#ifndef GESTUS_KERNELS_ATTENTION_INL_H_
#define GESTUS_KERNELS_ATTENTION_INL_H_

#include <cstddef>
#include <limits>

#include "kernels/dots.inl.h"
#include "kernels/gemm_pack.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"
#include "kernels/typed_rows.inl.h"

namespace gestus::kernels {
namespace {

constexpr std::size_t kKeyTile = 64;  // keys of a panel
constexpr float kMinusInfinity = -std::numeric_limits<float>::infinity();

/// Shape of the tile of sums.  Both operands are in near caches and none is streamed, so on AVX-512
/// few rows and many columns are better than the 14 x 2 of matrix products: fewer loads.
template <class Arch>
struct AttentionTile {
  static constexpr std::size_t kWidth = Batch<Arch>::size;
  static constexpr std::size_t kRows = kWidth == 16 ? 7 : GemmTile<Arch>::kRows;
  static constexpr std::size_t kVectors = kWidth == 16 ? 4 : GemmTile<Arch>::kVectors;
  static_assert(kVectors * kWidth <= kKeyTile);

  /// Vectors that are taken at once when `columns` columns are left, a whole tile wherever more
  /// than half of it is needed.
  static std::size_t vectors(std::size_t columns) {
    const std::size_t left = (columns + kWidth - 1) / kWidth;
    return left > 2 && left > kVectors / 2 ? kVectors : left > 1 ? 2 : 1;
  }
};

/// What a head needs beside its arguments, in floats; a bf16 pair takes the place of a float.
template <class Dot>
struct AttentionScratch {
  using Arch = typename Dot::Isa;
  static constexpr std::size_t kRows = AttentionTile<Arch>::kRows;
  std::size_t padded_keys;  // whole panels
  std::size_t head_groups, key_groups;
  std::size_t staging_stride, value_stride;  // whole vectors
  std::size_t score_stride;  // whole lines, an odd number of them, which spreads over the L1 cache

  AttentionScratch(std::size_t keys, std::size_t head_dim, std::size_t value_dim)
      : padded_keys(round_up(keys, kKeyTile)),
        head_groups((head_dim + Dot::kGroup - 1) / Dot::kGroup),
        key_groups((keys + Dot::kGroup - 1) / Dot::kGroup),
        staging_stride(round_up(head_dim, Batch<Arch>::size) / Dot::kGroup),
        value_stride(round_up(value_dim, Batch<Arch>::size)),
        score_stride(padded_keys + kLine / sizeof(float)) {}

  std::size_t keys_size() const { return padded_keys * head_groups; }
  std::size_t values_size() const { return key_groups * value_stride; }
  std::size_t scores_size() const { return kRows * score_stride; }
  std::size_t staging_size() const { return Dot::kPrepared ? kKeyTile * staging_stride : 0; }
  std::size_t size() const { return keys_size() + values_size() + scores_size() + staging_size(); }
};

/// One call, with keys and values packed.
template <class Dot>
struct PackedHead {
  const AttentionArgs& args;
  std::size_t head_groups, staging_stride, score_stride;
  const std::byte* keys;    // panels of kKeyTile keys: (head_groups, kKeyTile)
  const std::byte* values;  // (groups of keys, columns)
  std::size_t value_pitch;  // bytes from group to group
  float* scores;            // (rows of a tile, score_stride)
  float* staging;           // (kKeyTile, staging_stride): rows in the type of the products
};

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

/// Keys that `row` may see; they are its first ones.
GESTUS_INLINE std::size_t visible(const AttentionArgs& args, std::size_t row) {
  const std::size_t end = args.first_row + row + 1;
  return args.causal && end < args.keys ? end : args.keys;
}

/// sums (R, V vectors) += rows * w, groups of w `pitch` bytes apart.
template <class Dot, std::size_t R, std::size_t V>
GESTUS_INLINE void multiply_groups(DotSums<Dot, R, V>& sums,
                                   const typename Dot::Row* const (&rows)[R], const std::byte* w,
                                   std::size_t pitch, std::size_t groups) {
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) sums.v[r][v] = Dot::zero();
  }
  std::size_t g = 0;
  for (; g + kTileUnroll <= groups; g += kTileUnroll) {
#pragma GCC unroll 8
    for (std::size_t u = 0; u < kTileUnroll; ++u, w += pitch) {
      dot_step<Dot, R, V, 0, Dot::kPhases>(sums, rows, g + u, w);
    }
  }
  for (; g < groups; ++g, w += pitch) dot_step<Dot, R, V, 0, Dot::kPhases>(sums, rows, g, w);
}

/// Scores of R rows with V vectors of keys from `column` on.
template <class Dot, std::size_t R, std::size_t V>
GESTUS_INLINE void score_block(const PackedHead<Dot>& head,
                               const typename Dot::Row* const (&queries)[R], std::size_t column) {
  using Arch = typename Dot::Isa;
  const std::size_t panel = column / kKeyTile * kKeyTile;
  DotSums<Dot, R, V> sums;
  multiply_groups<Dot, R, V>(sums, queries,
                             head.keys + (panel * head.head_groups + column - panel) * Dot::kBytes,
                             kKeyTile * Dot::kBytes, head.head_groups);
  const Batch<Arch> scale(head.args.scale);
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) {
      (sums.v[r][v] * scale)
          .store_aligned(head.scores + r * head.score_stride + column + v * Batch<Arch>::size);
    }
  }
}

/// scores[from..columns) = -inf
template <class Arch>
GESTUS_INLINE void hide_rest(float* scores, std::size_t from, std::size_t columns) {
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const std::size_t whole = round_up(from, kWidth);
  for (std::size_t j = from; j < whole; ++j) scores[j] = kMinusInfinity;
  for (std::size_t j = whole; j < columns; j += kWidth) {
    Batch<Arch>(kMinusInfinity).store_aligned(scores + j);
  }
}

/// Turns rows of scores into weights e^(score - maximum), in the type of the products; `factors`
/// are what the weighted values are to be multiplied with.  The rows go through each stage
/// together: one alone would wait for its reductions.
template <class Dot, std::size_t R>
GESTUS_INLINE void weigh_rows(const PackedHead<Dot>& head, std::size_t row, std::size_t columns,
                              float (&factors)[R]) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const AttentionArgs& args = head.args;
  const auto scores = [&](std::size_t r) { return head.scores + r * head.score_stride; };
  for (std::size_t r = 0; r < R; ++r) {
    const std::size_t seen = visible(args, row + r);
    float* s = scores(r);
    for (std::size_t j = 0; args.key_bias && j < seen; ++j) s[j] += args.key_bias[j];
    if (seen < columns) hide_rest<Arch>(s, seen, columns);
  }
  Batch<Arch> best[R], sum[R];
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) best[r] = Batch<Arch>(kMinusInfinity);
  for (std::size_t j = 0; j < columns; j += kWidth) {
#pragma GCC unroll 16
    for (std::size_t r = 0; r < R; ++r) {
      best[r] = xsimd::max(best[r], Batch<Arch>::load_aligned(scores(r) + j));
    }
  }
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    const float top = largest<Arch>(best[r]);
    // While everything is masked the maximum is -inf; against 0 the weights are e^-inf = 0.
    best[r] = Batch<Arch>(top == kMinusInfinity ? 0.0f : top);
    sum[r] = Batch<Arch>(0.0f);
  }
  for (std::size_t j = 0; j < columns; j += kWidth) {
#pragma GCC unroll 16
    for (std::size_t r = 0; r < R; ++r) {
      const Batch<Arch> weight = vexp(Batch<Arch>::load_aligned(scores(r) + j) - best[r]);
      sum[r] += weight;
      if constexpr (Dot::kPrepared) {
        // Narrower than the scores, so it never overtakes them.
        Dot::store_row(reinterpret_cast<std::byte*>(scores(r)) + j * Dot::kElementBytes, weight);
      } else {
        weight.store_aligned(scores(r) + j);
      }
    }
  }
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    const float total = xsimd::hadd(sum[r]);
    factors[r] = total > 0.0f || total != total ? 1.0f / total : 0.0f;
  }
}

/// out (R, V vectors) = factors * weights * values; of the last vector `last` columns.
template <class Dot, std::size_t R, std::size_t V>
GESTUS_INLINE void value_block(const PackedHead<Dot>& head, std::size_t row, std::size_t column,
                               const float (&factors)[R], std::size_t keys, std::size_t last) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size;
  const typename Dot::Row* weights[R];
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    weights[r] = reinterpret_cast<const typename Dot::Row*>(head.scores + r * head.score_stride);
  }
  DotSums<Dot, R, V> sums;
  multiply_groups<Dot, R, V>(sums, weights, head.values + column * Dot::kBytes, head.value_pitch,
                             (keys + Dot::kGroup - 1) / Dot::kGroup);
  // + 0 turns -0 into +0: which of them a masked key leaves depends on the tile that it falls into.
  const Batch<Arch> zero(0.0f);
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    float* out = head.args.out + row_offset(row + r, head.args.out_stride) + column;
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) {
      const Batch<Arch> y = sums.v[r][v] * Batch<Arch>(factors[r]) + zero;
      if (v + 1 == V && last < kWidth) {
        store_first<Arch>(out + v * kWidth, last, y);
      } else {
        y.store_unaligned(out + v * kWidth);
      }
    }
  }
}

/// Calls f with `vectors`, which is 1, 2 or V, as a compile-time constant.
template <std::size_t V, class F>
GESTUS_INLINE void with_vectors(std::size_t vectors, const F& f) {
  if (vectors == 1) return f(std::integral_constant<std::size_t, 1>{});
  if constexpr (V > 2) {
    if (vectors == 2) return f(std::integral_constant<std::size_t, 2>{});
  }
  f(std::integral_constant<std::size_t, V>{});
}

/// Asks for the R query rows from `row` on, which the next tile begins with: they lie far apart.
template <std::size_t R>
GESTUS_INLINE void ask_for_rows(const AttentionArgs& args, std::size_t row) {
  for (std::size_t r = row; r < row + R && r < args.rows; ++r) {
    const auto begin = reinterpret_cast<std::uintptr_t>(args.q + row_offset(r, args.q_stride));
    for (std::size_t at = 0; at < args.head_dim * sizeof(float); at += kLine) prefetch(begin + at);
  }
}

/// Query rows [row, row + R).
template <class Dot, std::size_t R>
[[gnu::noinline]] void attend_rows(const PackedHead<Dot>& head, std::size_t row) {
  using Tile = AttentionTile<typename Dot::Isa>;
  const AttentionArgs& args = head.args;
  const std::size_t keys = visible(args, row + R - 1);
  const typename Dot::Row* queries[R];
  for (std::size_t r = 0; r < R; ++r) {
    const float* q = args.q + row_offset(row + r, args.q_stride);
    if constexpr (Dot::kPrepared) {
      float* prepared = head.staging + r * head.staging_stride;
      round_row<Dot>(reinterpret_cast<std::byte*>(prepared), q, args.head_dim);
      queries[r] = reinterpret_cast<const typename Dot::Row*>(prepared);
    } else {
      queries[r] = q;
    }
  }
  ask_for_rows<R>(args, row + R);
  std::size_t columns = 0;
  while (columns < keys) {
    const std::size_t vectors = Tile::vectors(keys - columns);
    with_vectors<Tile::kVectors>(vectors,
                                 [&](auto v) { score_block<Dot, R, v()>(head, queries, columns); });
    columns += vectors * Tile::kWidth;
  }
  float factors[R];
  weigh_rows<Dot, R>(head, row, columns, factors);
  for (std::size_t c = 0; c < args.value_dim;) {
    const std::size_t left = args.value_dim - c;
    // Beyond the last column there is nothing to write to, so no more vectors than are needed.
    const std::size_t vectors = left >= Tile::kVectors * Tile::kWidth ? Tile::kVectors
                                : left > Tile::kWidth                 ? 2
                                                                      : 1;
    const std::size_t end = vectors * Tile::kWidth;
    const std::size_t last = left < end ? left - (end - Tile::kWidth) : Tile::kWidth;
    with_vectors<Tile::kVectors>(
        vectors, [&](auto v) { value_block<Dot, R, v()>(head, row, c, factors, keys, last); });
    c += end;
  }
}

/// Panels of keys [0, keys): (panels, head_groups, kKeyTile), zeros for keys that a panel lacks.
template <class Dot>
GESTUS_INLINE void pack_keys(float* panels, const AttentionArgs& args, std::size_t keys,
                             const AttentionScratch<Dot>& sizes, float* staging) {
  for (std::size_t begin = 0; begin < keys; begin += kKeyTile) {
    const std::size_t count = keys - begin < kKeyTile ? keys - begin : kKeyTile;
    const float* k = args.k + row_offset(begin, args.k_stride);
    std::ptrdiff_t stride = args.k_stride;
    if constexpr (Dot::kPrepared) {
      for (std::size_t j = 0; j < count; ++j) {
        round_row<Dot>(reinterpret_cast<std::byte*>(staging + j * sizes.staging_stride),
                       k + row_offset(j, args.k_stride), args.head_dim);
      }
      k = staging;
      stride = static_cast<std::ptrdiff_t>(sizes.staging_stride);
    }
    transpose_padded(panels + begin * sizes.head_groups, kKeyTile, k, stride, count,
                     round_up(count, Batch<typename Dot::Isa>::size), sizes.head_groups);
  }
}

/// Values of keys [0, keys): (groups of keys, value_stride), zeros behind the last column and key.
template <class Dot>
GESTUS_INLINE void pack_values(float* out, const AttentionArgs& args, std::size_t keys,
                               const AttentionScratch<Dot>& sizes) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kWidth = Batch<Arch>::size;
  for (std::size_t j = 0; j < keys; j += Dot::kGroup, out += sizes.value_stride) {
    const float* v = args.v + row_offset(j, args.v_stride);
    const bool pair = Dot::kGroup == 2 && j + 1 < keys;
    for (std::size_t c = 0; c < args.value_dim; c += kWidth) {
      const std::size_t left = args.value_dim - c;
      const auto load = [left](const float* p) {
        return left < kWidth ? load_first<Arch>(p, left) : Batch<Arch>::load_unaligned(p);
      };
      if constexpr (Dot::kGroup == 1) {
        load(v + c).store_unaligned(out + c);
      } else {
        Dot::pair(load(v + c), pair ? load(v + args.v_stride + c) : Batch<Arch>(0.0f))
            .store_unaligned(out + c);
      }
    }
  }
}

template <class Dot>
std::size_t attention_scratch(std::size_t /*rows*/, std::size_t keys, std::size_t head_dim,
                              std::size_t value_dim) {
  return AttentionScratch<Dot>(keys, head_dim, value_dim).size();
}

template <class Dot>
void attention(const AttentionArgs& args) {
  using Tile = AttentionTile<typename Dot::Isa>;
  const std::size_t keys = args.rows > 0 ? visible(args, args.rows - 1) : 0;
  const AttentionScratch<Dot> sizes(args.keys, args.head_dim, args.value_dim);
  float* const panels = args.scratch;
  float* const values = panels + sizes.keys_size();
  float* const scores = values + sizes.values_size();
  float* const staging = scores + sizes.scores_size();
  pack_keys<Dot>(panels, args, keys, sizes, staging);
  PackedHead<Dot> head{args,
                       sizes.head_groups,
                       sizes.staging_stride,
                       sizes.score_stride,
                       reinterpret_cast<const std::byte*>(panels),
                       reinterpret_cast<const std::byte*>(args.v),
                       static_cast<std::size_t>(args.v_stride) * sizeof(float),
                       scores,
                       staging};
  // A tile reads whole vectors; and copied rows lie close together, which pays when many read them.
  if (Dot::kPrepared || args.rows > Tile::kRows || args.value_dim % Tile::kWidth != 0) {
    pack_values<Dot>(values, args, keys, sizes);
    head.values = reinterpret_cast<const std::byte*>(values);
    head.value_pitch = sizes.value_stride * sizeof(float);
  }
  for (std::size_t row = 0; row < args.rows;) {
    const std::size_t rows = next_tile_rows<Tile>(args.rows - row);
    with_rows<Tile::kRows>(rows, [&](auto r) { attend_rows<Dot, r()>(head, row); });
    row += rows;
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_ATTENTION_INL_H_
