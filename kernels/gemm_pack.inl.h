// Transposition in 4 x 4 squares: how every packed layout (GEMM panels, LSTM blocks, the keys of
// attention) comes from row-major rows.
#ifndef GESTUS_KERNELS_GEMM_PACK_INL_H_
#define GESTUS_KERNELS_GEMM_PACK_INL_H_

#include <cstddef>
#include <xsimd/xsimd.hpp>

namespace gestus::kernels {
namespace {

// Four lanes: wider registers zip inside 128-bit lanes only.
#if defined(__aarch64__)
using Quad = xsimd::batch<float, xsimd::neon64>;
#else
using Quad = xsimd::batch<float, xsimd::sse2>;
#endif

[[gnu::always_inline]] inline void transpose_square(float* out, std::ptrdiff_t out_stride,
                                                    const float* in, std::ptrdiff_t in_stride) {
  const Quad r0 = Quad::load_unaligned(in);
  const Quad r1 = Quad::load_unaligned(in + in_stride);
  const Quad r2 = Quad::load_unaligned(in + 2 * in_stride);
  const Quad r3 = Quad::load_unaligned(in + 3 * in_stride);
  const Quad even_lo = xsimd::zip_lo(r0, r2), even_hi = xsimd::zip_hi(r0, r2);
  const Quad odd_lo = xsimd::zip_lo(r1, r3), odd_hi = xsimd::zip_hi(r1, r3);
  xsimd::zip_lo(even_lo, odd_lo).store_unaligned(out);
  xsimd::zip_hi(even_lo, odd_lo).store_unaligned(out + out_stride);
  xsimd::zip_lo(even_hi, odd_hi).store_unaligned(out + 2 * out_stride);
  xsimd::zip_hi(even_hi, odd_hi).store_unaligned(out + 3 * out_stride);
}

#if defined(__AVX512F__)
/// Columns [0, 4) of 16 rows: four squares of 4 x 4 in the lanes of a register.
[[gnu::always_inline]] inline void transpose_strip(float* out, std::ptrdiff_t out_stride,
                                                   const float* in, std::ptrdiff_t in_stride) {
  __m512 x[4];
  for (int i = 0; i < 4; ++i, in += in_stride) {
    const auto lane = [&](int n) { return _mm_loadu_ps(in + 4 * n * in_stride); };
    x[i] = _mm512_insertf32x4(_mm512_castps128_ps512(lane(0)), lane(1), 1);
    x[i] = _mm512_insertf32x4(x[i], lane(2), 2);
    x[i] = _mm512_insertf32x4(x[i], lane(3), 3);
  }
  const __m512 even_lo = _mm512_unpacklo_ps(x[0], x[2]), even_hi = _mm512_unpackhi_ps(x[0], x[2]);
  const __m512 odd_lo = _mm512_unpacklo_ps(x[1], x[3]), odd_hi = _mm512_unpackhi_ps(x[1], x[3]);
  _mm512_storeu_ps(out, _mm512_unpacklo_ps(even_lo, odd_lo));
  _mm512_storeu_ps(out + out_stride, _mm512_unpackhi_ps(even_lo, odd_lo));
  _mm512_storeu_ps(out + 2 * out_stride, _mm512_unpacklo_ps(even_hi, odd_hi));
  _mm512_storeu_ps(out + 3 * out_stride, _mm512_unpackhi_ps(even_hi, odd_hi));
}
#endif

/// out (cols, padded_rows) = in (rows, cols) transposed, with zeros for the rows that `in` lacks.
/// padded_rows must be a multiple of 4.
inline void transpose_padded(float* out, std::ptrdiff_t out_stride, const float* in,
                             std::ptrdiff_t in_stride, std::size_t rows, std::size_t padded_rows,
                             std::size_t cols) {
  constexpr std::size_t kSide = 4;
  std::size_t r = 0;
#if defined(__AVX512F__)
  for (; cols % kSide == 0 && r + 16 <= rows; r += 16) {
    const float* source = in + static_cast<std::ptrdiff_t>(r) * in_stride;
    for (std::size_t c = 0; c < cols; c += kSide) {
      transpose_strip(out + r + static_cast<std::ptrdiff_t>(c) * out_stride, out_stride, source + c,
                      in_stride);
    }
  }
#endif
  for (; r < padded_rows; r += kSide) {
    const float* source = in + static_cast<std::ptrdiff_t>(r) * in_stride;
    float* target = out + r;
    std::size_t c = 0;
    if (r + kSide <= rows) {
      for (; c + kSide <= cols; c += kSide) {
        transpose_square(target + static_cast<std::ptrdiff_t>(c) * out_stride, out_stride,
                         source + c, in_stride);
      }
    }
    for (; c < cols; ++c) {
      for (std::size_t i = 0; i < kSide; ++i) {
        target[static_cast<std::ptrdiff_t>(c) * out_stride + static_cast<std::ptrdiff_t>(i)] =
            r + i < rows ? source[static_cast<std::ptrdiff_t>(i) * in_stride +
                                  static_cast<std::ptrdiff_t>(c)]
                         : 0.0f;
      }
    }
  }
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_GEMM_PACK_INL_H_
