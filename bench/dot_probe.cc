// The loop that finds how fast an instruction set multiplies narrow numbers; built once for
// vdpbf16ps (GESTUS_DOT_BF16) and once for vpdpbusd.
#include <immintrin.h>

#include <cstddef>

namespace gestus::bench {

// Sixteen chains cover the latency of two pipes of up to eight cycles.  Returns the number of
// operations.
constexpr std::size_t kChains = 16;

#ifdef GESTUS_DOT_BF16

double DotProbe_bf16(std::size_t repeat, float* sink) {
  const auto x = (__m512bh)_mm512_set1_epi32(0x3f80'3f80), y = x;  // ones
  __m512 sum[kChains];
#pragma GCC unroll 16
  for (std::size_t i = 0; i < kChains; ++i) sum[i] = _mm512_set1_ps(static_cast<float>(i));
  for (std::size_t n = 0; n < repeat; ++n) {
#pragma GCC unroll 16
    for (std::size_t i = 0; i < kChains; ++i) sum[i] = _mm512_dpbf16_ps(sum[i], x, y);
  }
#pragma GCC unroll 16
  for (std::size_t i = 1; i < kChains; ++i) sum[0] = _mm512_add_ps(sum[0], sum[i]);
  *sink = _mm512_cvtss_f32(sum[0]);
  return 2.0 * static_cast<double>(repeat * kChains * 32);
}

#else

double DotProbe_int8(std::size_t repeat, float* sink) {
  const __m512i x = _mm512_set1_epi8(1), y = x;
  __m512i sum[kChains];
#pragma GCC unroll 16
  for (std::size_t i = 0; i < kChains; ++i) sum[i] = _mm512_set1_epi32(static_cast<int>(i));
  for (std::size_t n = 0; n < repeat; ++n) {
#pragma GCC unroll 16
    for (std::size_t i = 0; i < kChains; ++i) sum[i] = _mm512_dpbusd_epi32(sum[i], x, y);
  }
#pragma GCC unroll 16
  for (std::size_t i = 1; i < kChains; ++i) sum[0] = _mm512_add_epi32(sum[0], sum[i]);
  *sink = static_cast<float>(_mm_cvtsi128_si32(_mm512_castsi512_si128(sum[0])));
  return 2.0 * static_cast<double>(repeat * kChains * 64);
}

#endif

}  // namespace gestus::bench
