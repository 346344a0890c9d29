// How rows of a meet weights of 8 or 16 bits in vector registers: one struct for each way, with the
// same members, so that one tile, one GEMV and one LSTM step serve all of them (typed_*.inl.h).
//
// Packed weights of a panel are groups of k: for each group, every column's kGroup weights side by
// side in kBytes.  A row of a is a sequence of `Row` elements; `broadcast` gives what the columns
// of one group are multiplied with, in kPhases parts.
#ifndef GESTUS_KERNELS_DOTS_INL_H_
#define GESTUS_KERNELS_DOTS_INL_H_

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <xsimd/xsimd.hpp>

#include "kernels/gemm_tile.inl.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

template <class Arch>
using Ints = xsimd::batch<std::int32_t, Arch>;

template <class Arch>
GESTUS_INLINE Ints<Arch> load_ints(const std::byte* p) {
  return Ints<Arch>::load_unaligned(reinterpret_cast<const std::int32_t*>(p));
}

/// Hides from the compiler where x comes from.
template <class Arch>
GESTUS_INLINE void keep_in_register(Batch<Arch>& x) {
#if defined(__x86_64__)
  asm("" : "+v"(x.data));
#else
  (void)x;
#endif
}

/// What the scales and corrections behind a panel make of a sum; nothing for bf16.
template <class Arch>
struct FloatSums {
  static constexpr std::size_t kTrailerBytes = 0;  // of each column, behind its groups
  using Sum = Batch<Arch>;
  GESTUS_INLINE static Sum zero() { return Sum(0.0f); }
  GESTUS_INLINE static Sum add(const Sum& a, const Sum& b) { return a + b; }
  GESTUS_INLINE static Batch<Arch> result(const Sum& sum, float, const std::byte*, std::size_t) {
    return sum;
  }
};

/// Int32 sums to floats: (sum - correction) * scale of the row * scale of the column.
template <class Arch>
struct IntSums {
  static constexpr std::size_t kTrailerBytes = sizeof(float) + sizeof(std::int32_t);
  using Sum = Ints<Arch>;
  GESTUS_INLINE static Sum zero() { return Sum(0); }
  GESTUS_INLINE static Sum add(const Sum& a, const Sum& b) { return a + b; }
  /// `trailer` holds a scale for each of `columns`, then a correction for each.
  GESTUS_INLINE static Batch<Arch> result(const Sum& sum, float row_scale, const std::byte* trailer,
                                          std::size_t columns) {
    const auto* scales = reinterpret_cast<const float*>(trailer);
    const Sum right = sum - load_ints<Arch>(trailer + columns * sizeof(float));
    return xsimd::to_float(right) * Batch<Arch>(row_scale) * Batch<Arch>::load_unaligned(scales);
  }
};

/// float32 weights and rows as they are.
template <class Arch>
struct Float32 : FloatSums<Arch> {
  using Isa = Arch;
  using Sum = Batch<Arch>;
  using Row = float;
  static constexpr bool kPrepared = false;
  static constexpr std::size_t kGroup = 1, kBytes = 4, kPhases = 1;

  template <std::size_t>
  GESTUS_INLINE static Sum load(const std::byte* p) {
    return Sum::load_unaligned(reinterpret_cast<const float*>(p));
  }
  template <std::size_t>
  GESTUS_INLINE static Sum broadcast(const Row* row, std::size_t group) {
    return Sum(row[group]);
  }
  GESTUS_INLINE static Sum dot(const Sum& sum, const Sum& x, const Sum& w) {
    return multiply_add(x, w, sum);
  }
  GESTUS_INLINE static void keep(const Sum& x) { keep_alive<Arch>(x); }
};

/// bf16 weights widened, two halves of a 32-bit lane one after the other; rows are float32.
template <class Arch>
struct WidenedBf16 : FloatSums<Arch> {
  using Isa = Arch;
  using Sum = Batch<Arch>;
  using Row = float;
  static constexpr const char* kHow = "widened";
  static constexpr bool kPrepared = false;
  static constexpr std::size_t kGroup = 2, kBytes = 4, kPhases = 2, kPadGroups = 1;

  template <std::size_t kPhase>
  GESTUS_INLINE static Sum load(const std::byte* p) {
    if constexpr (kPhase == 0) {
      return xsimd::bitwise_cast<Sum>(load_ints<Arch>(p) << 16);
    } else {
#if defined(__AVX512BW__)
      if constexpr (Sum::size == 16)
        return _mm512_castsi512_ps(_mm512_maskz_loadu_epi16(0xaaaaaaaau, p));
#endif
      // Not by a mask, as GCC would have it: AVX2's tile has no register left for one.
      Sum upper = xsimd::bitwise_cast<Sum>(load_ints<Arch>(p) >> 16);
      keep_in_register(upper);
      return xsimd::bitwise_cast<Sum>(xsimd::bitwise_cast<Ints<Arch>>(upper) << 16);
    }
  }
  template <std::size_t kPhase>
  GESTUS_INLINE static Sum broadcast(const Row* row, std::size_t group) {
    return Sum(row[group * kGroup + kPhase]);
  }
  GESTUS_INLINE static Sum dot(const Sum& sum, const Sum& x, const Sum& w) {
#if defined(__FMA__) && !defined(__AVX512F__)
    // GCC would put sums where dying operands are, and pay with spills of the tile.
    Sum result = sum;
    asm("vfmadd231ps %2, %1, %0" : "+x"(result.data) : "x"(x.data), "x"(w.data));
    return result;
#else
    return multiply_add(x, w, sum);
#endif
  }
  GESTUS_INLINE static void keep(const Sum& x) { keep_alive<Arch>(x); }
};

// 16-bit products added in pairs, exact for |x|, |w| <= 127: what AVX2's 8-bit multiply-add, which
// saturates at 16 bits, is not.
#if defined(__AVX512BW__)
GESTUS_INLINE __m512i widen_pairs(const std::byte* p) {
  return _mm512_cvtepi8_epi16(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)));
}
GESTUS_INLINE __m512i add_pairs(__m512i x, __m512i w) { return _mm512_madd_epi16(x, w); }
GESTUS_INLINE void store_shorts(std::byte* p, __m512i x) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm512_cvtepi32_epi16(x));
}
#elif defined(__AVX2__)
GESTUS_INLINE __m256i widen_pairs(const std::byte* p) {
  return _mm256_cvtepi8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
GESTUS_INLINE __m256i add_pairs(__m256i x, __m256i w) { return _mm256_madd_epi16(x, w); }
GESTUS_INLINE void store_shorts(std::byte* p, __m256i x) {
  const __m128i shorts = _mm_packs_epi32(_mm256_castsi256_si128(x), _mm256_extracti128_si256(x, 1));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), shorts);
}
#elif defined(__SSE2__)
GESTUS_INLINE __m128i widen_pairs(const std::byte* p) {
  const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
  return _mm_srai_epi16(_mm_unpacklo_epi8(bytes, bytes), 8);
}
GESTUS_INLINE __m128i add_pairs(__m128i x, __m128i w) { return _mm_madd_epi16(x, w); }
GESTUS_INLINE void store_shorts(std::byte* p, __m128i x) {
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_packs_epi32(x, x));
}
#elif defined(__aarch64__)
GESTUS_INLINE int32x4_t widen_pairs(const std::byte* p) {
  return vreinterpretq_s32_s16(vmovl_s8(vld1_s8(reinterpret_cast<const std::int8_t*>(p))));
}
GESTUS_INLINE int32x4_t add_pairs(int32x4_t x, int32x4_t w) {
  const int16x8_t a = vreinterpretq_s16_s32(x), b = vreinterpretq_s16_s32(w);
  return vpaddq_s32(vmull_s16(vget_low_s16(a), vget_low_s16(b)), vmull_high_s16(a, b));
}
GESTUS_INLINE void store_shorts(std::byte* p, int32x4_t x) {
  vst1_s16(reinterpret_cast<std::int16_t*>(p), vmovn_s32(x));
}
#endif

template <class Arch>
struct PairsI8 : IntSums<Arch> {
  using Isa = Arch;
  using Sum = Ints<Arch>;
  using Row = std::uint32_t;  // two int16
  static constexpr const char* kHow = "16-bit pairs";
  static constexpr bool kPrepared = true;
  static constexpr std::size_t kGroup = 2, kBytes = 2, kPhases = 1, kPadGroups = 1;

  template <std::size_t>
  GESTUS_INLINE static Sum load(const std::byte* p) {
    return widen_pairs(p);
  }
  template <std::size_t>
  GESTUS_INLINE static Sum broadcast(const Row* row, std::size_t group) {
    return Sum(static_cast<std::int32_t>(row[group]));
  }
  GESTUS_INLINE static Sum dot(const Sum& sum, const Sum& x, const Sum& w) {
    return sum + Sum(add_pairs(x, w));
  }
  GESTUS_INLINE static void keep(const Sum&) {}

  // Rows: q as int16, so that two of them are one element.
  static constexpr std::size_t kElementBytes = 2;
  static constexpr Row kZeroRow = 0;
  GESTUS_INLINE static void store_row(std::byte* p, const Sum& q) { store_shorts(p, q); }
};

template <class Dot, std::size_t R, std::size_t V>
struct DotSums {
  typename Dot::Sum v[R][V];
};

/// sums[r][:] += the products of one group, of which `kPhases` parts are wanted.
template <class Dot, std::size_t R, std::size_t V, std::size_t kPhase, std::size_t kPhases>
GESTUS_INLINE void dot_step(DotSums<Dot, R, V>& sums, const typename Dot::Row* const (&rows)[R],
                            std::size_t group, const std::byte* w) {
  constexpr std::size_t kVectorBytes = Batch<typename Dot::Isa>::size * Dot::kBytes;
  decltype(Dot::template load<kPhase>(w)) columns[V];
#pragma GCC unroll 8
  for (std::size_t v = 0; v < V; ++v) {
    columns[v] = Dot::template load<kPhase>(w + v * kVectorBytes);
  }
#pragma GCC unroll 16
  for (std::size_t r = 0; r < R; ++r) {
    const auto x = Dot::template broadcast<kPhase>(rows[r], group);
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) sums.v[r][v] = Dot::dot(sums.v[r][v], x, columns[v]);
    Dot::keep(x);
  }
  if constexpr (R > 1) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < V; ++v) Dot::keep(columns[v]);
  }
  if constexpr (kPhase + 1 < kPhases) {
    dot_step<Dot, R, V, kPhase + 1, kPhases>(sums, rows, group, w);
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_DOTS_INL_H_
