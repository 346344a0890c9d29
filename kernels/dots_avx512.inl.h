// Dot products that AVX-512 has instructions for.  Included by isa/avx512_*.cc, whose flags allow
// them.
#ifndef GESTUS_KERNELS_DOTS_AVX512_INL_H_
#define GESTUS_KERNELS_DOTS_AVX512_INL_H_

#include "kernels/dots.inl.h"

namespace gestus::kernels {
namespace {

// Groups are padded to what AMX reads at once, so that both share packed weights.
constexpr std::size_t kAmxGroups = 16;

#if defined(__AVX512VNNI__)
/// Four 8-bit products at once.  The instruction wants one operand unsigned: rows are stored with
/// 128 added, and the correction, 128 times the sum of a column's weights, takes it off again.
struct VnniI8 : IntSums<xsimd::avx512bw> {
  using Isa = xsimd::avx512bw;
  using Row = std::uint32_t;  // four q + 128
  static constexpr const char* kHow = "vpdpbusd";
  static constexpr bool kPrepared = true;
  static constexpr std::size_t kGroup = 4, kBytes = 4, kPhases = 1, kPadGroups = kAmxGroups;

  template <std::size_t>
  GESTUS_INLINE static Sum load(const std::byte* p) {
    return load_ints<Isa>(p);
  }
  template <std::size_t>
  GESTUS_INLINE static Sum broadcast(const Row* row, std::size_t group) {
    return Sum(static_cast<std::int32_t>(row[group]));
  }
  GESTUS_INLINE static Sum dot(const Sum& sum, const Sum& x, const Sum& w) {
    return _mm512_dpbusd_epi32(sum, x, w);
  }
  GESTUS_INLINE static void keep(const Sum&) {}

  static constexpr std::size_t kElementBytes = 1;
  static constexpr Row kZeroRow = 0x80808080u;
  GESTUS_INLINE static void store_row(std::byte* p, const Sum& q) {
    const __m512i shifted = _mm512_add_epi32(q, _mm512_set1_epi32(128));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm512_cvtepi32_epi8(shifted));
  }
};
#endif

#if defined(__AVX512BF16__)
/// Two bf16 products at once, rows rounded to bf16.
struct NativeBf16 : FloatSums<xsimd::avx512bw> {
  using Isa = xsimd::avx512bw;
  using Row = std::uint32_t;  // two bf16
  static constexpr const char* kHow = "vdpbf16ps";
  static constexpr bool kPrepared = true;
  static constexpr std::size_t kGroup = 2, kBytes = 4, kPhases = 1, kPadGroups = kAmxGroups;

  template <std::size_t>
  GESTUS_INLINE static Ints<Isa> load(const std::byte* p) {
    return load_ints<Isa>(p);
  }
  template <std::size_t>
  GESTUS_INLINE static Ints<Isa> broadcast(const Row* row, std::size_t group) {
    return Ints<Isa>(static_cast<std::int32_t>(row[group]));
  }
  GESTUS_INLINE static Sum dot(const Sum& sum, const Ints<Isa>& x, const Ints<Isa>& w) {
    const auto a = reinterpret_cast<__m512bh>(static_cast<__m512i>(x));
    const auto b = reinterpret_cast<__m512bh>(static_cast<__m512i>(w));
    return _mm512_dpbf16_ps(sum, a, b);
  }
  GESTUS_INLINE static void keep(const Ints<Isa>&) {}

  static constexpr std::size_t kElementBytes = 2;
  GESTUS_INLINE static void store_row(std::byte* p, const Sum& x) {
    const auto shorts = reinterpret_cast<__m256i>(_mm512_cvtneps_pbh(x));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), shorts);
  }
  /// Lanes of two values, `even` in the lower half.
  GESTUS_INLINE static Sum pair(const Sum& even, const Sum& odd) {
    const auto widen = [](const Sum& y) {
      return _mm512_cvtepu16_epi32(reinterpret_cast<__m256i>(_mm512_cvtneps_pbh(y)));
    };
    return _mm512_castsi512_ps(_mm512_or_si512(widen(even), _mm512_slli_epi32(widen(odd), 16)));
  }
};
#endif

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_DOTS_AVX512_INL_H_
