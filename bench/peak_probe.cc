// The loops behind peak.h, compiled once per instruction set; GESTUS_ISA is its name.
#include <cstddef>
#include <xsimd/xsimd.hpp>

#include "kernels/math.inl.h"

#define GESTUS_CONCAT_(a, b) a##b
#define GESTUS_CONCAT(a, b) GESTUS_CONCAT_(a, b)

namespace gestus::bench {
namespace {

using Arch = xsimd::default_arch;  // the best that this object's flags allow
using Batch = xsimd::batch<float, Arch>;

}  // namespace

// Twelve chains cover the latency of two pipes of five cycles.  Returns the number of operations.
double GESTUS_CONCAT(FmaProbe_, GESTUS_ISA)(std::size_t repeat, float* sink) {
  constexpr std::size_t kChains = 12;
  const Batch x(0.999f), y(0.001f);
  Batch sum[kChains];
#pragma GCC unroll 16
  for (std::size_t i = 0; i < kChains; ++i) sum[i] = Batch(static_cast<float>(i));
  for (std::size_t n = 0; n < repeat; ++n) {
#pragma GCC unroll 16
    for (std::size_t i = 0; i < kChains; ++i) sum[i] = kernels::multiply_add<Arch>(sum[i], x, y);
  }
#pragma GCC unroll 16
  for (std::size_t i = 1; i < kChains; ++i) sum[0] += sum[i];
  *sink = xsimd::hadd(sum[0]);
  return 2.0 * static_cast<double>(repeat * kChains * Batch::size);
}

void GESTUS_CONCAT(ReadProbe_, GESTUS_ISA)(const float* p, std::size_t n, float* sink) {
  constexpr std::size_t kChains = 8;
  Batch sum[kChains];
#pragma GCC unroll 8
  for (std::size_t i = 0; i < kChains; ++i) sum[i] = Batch(0.0f);
  for (std::size_t j = 0; j + kChains * Batch::size <= n; j += kChains * Batch::size) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kChains; ++i)
      sum[i] += Batch::load_unaligned(p + j + i * Batch::size);
  }
#pragma GCC unroll 8
  for (std::size_t i = 1; i < kChains; ++i) sum[0] += sum[i];
  *sink = xsimd::hadd(sum[0]);
}

}  // namespace gestus::bench
