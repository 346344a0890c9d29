// Calls the probes of peak_probe.cc and keeps the best of several runs.
#include "bench/peak.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace gestus::bench {
namespace {

using kernels::Isa;

struct Probe {
  double (*fma)(std::size_t repeat, float* sink);
  void (*read)(const float* p, std::size_t n, float* sink);
};

}  // namespace

#define GESTUS_DECLARE_PROBE(isa)                         \
  double FmaProbe_##isa(std::size_t repeat, float* sink); \
  void ReadProbe_##isa(const float* p, std::size_t n, float* sink);
GESTUS_DECLARE_PROBE(sse2)
GESTUS_DECLARE_PROBE(avx2)
GESTUS_DECLARE_PROBE(avx512)
GESTUS_DECLARE_PROBE(neon)
#undef GESTUS_DECLARE_PROBE
double DotProbe_bf16(std::size_t repeat, float* sink);
double DotProbe_int8(std::size_t repeat, float* sink);

namespace {

Probe ProbeFor(Isa isa) {
  switch (isa) {
#ifdef GESTUS_HAVE_SSE2
    case Isa::kSse2:
      return {FmaProbe_sse2, ReadProbe_sse2};
#endif
#ifdef GESTUS_HAVE_AVX2
    case Isa::kAvx2:
      return {FmaProbe_avx2, ReadProbe_avx2};
#endif
#ifdef GESTUS_HAVE_AVX512
    case Isa::kAvx512:
    case Isa::kAvx512Vnni:
    case Isa::kAvx512Bf16:
    case Isa::kAvx512Amx:
      return {FmaProbe_avx512, ReadProbe_avx512};
#endif
#ifdef GESTUS_HAVE_NEON
    case Isa::kNeon:
      return {FmaProbe_neon, ReadProbe_neon};
#endif
    default:
      return {nullptr, nullptr};
  }
}

double Seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr std::size_t kRepeat = 50000;
constexpr int kRuns = 9;

double Best(double (*fma)(std::size_t, float*)) {
  double best = 0.0;
  float sink;
  for (int run = 0; run < kRuns; ++run) {
    const double start = Seconds();
    const double flops = fma(kRepeat, &sink);
    best = std::max(best, flops / (Seconds() - start) * 1e-9);
  }
  return best;
}

}  // namespace

double PeakGflops(Isa isa) {
  const Probe probe = ProbeFor(isa);
  return probe.fma != nullptr ? Best(probe.fma) : 0.0;
}

DotPeak PeakOfDots([[maybe_unused]] Isa isa, [[maybe_unused]] DotType type) {
#ifdef GESTUS_HAVE_AVX512_BF16
  const bool bf16 = isa == Isa::kAvx512Bf16 || isa == Isa::kAvx512Amx;
  if (type == DotType::kBf16 && bf16) return {"vdpbf16ps", Best(DotProbe_bf16)};
#endif
#ifdef GESTUS_HAVE_AVX512_VNNI
  const bool vnni =
      isa == Isa::kAvx512Vnni || isa == Isa::kAvx512Bf16 || isa == Isa::kAvx512Amx;
  if (type == DotType::kInt8 && vnni) return {"vpdpbusd", Best(DotProbe_int8)};
#endif
  return {"", 0.0};
}

double PeakGflopsAllCores(Isa isa) {
  const Probe probe = ProbeFor(isa);
  if (probe.fma == nullptr) return 0.0;
  // Best of the process, not of this call: with a core taken by somebody else all runs are slow.
  static double best_of[8] = {};
  double& best = best_of[static_cast<std::size_t>(isa)];
  for (int run = 0; run < kRuns; ++run) {
    double flops = 0.0, start = 0.0;
#pragma omp parallel reduction(+ : flops)
    {
#pragma omp barrier
#pragma omp master
      start = Seconds();
      float sink;
      flops += probe.fma(4 * kRepeat, &sink);
    }
    best = std::max(best, flops / (Seconds() - start) * 1e-9);
  }
  return best;
}

double ReadGbps(Isa isa, std::size_t bytes) {
  const Probe probe = ProbeFor(isa);
  if (probe.read == nullptr) return 0.0;
  const std::vector<float> data(bytes / sizeof(float), 1.0f);
  const std::size_t passes = std::max<std::size_t>(1, (std::size_t{1} << 24) / bytes);
  double best = 0.0;
  float sink;
  for (int run = 0; run < kRuns; ++run) {
    const double start = Seconds();
    for (std::size_t pass = 0; pass < passes; ++pass) probe.read(data.data(), data.size(), &sink);
    best = std::max(best, static_cast<double>(bytes * passes) / (Seconds() - start) * 1e-9);
  }
  return best;
}

}  // namespace gestus::bench
