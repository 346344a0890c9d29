// See common.h.
#include "bench/kernels/common.h"

#include <algorithm>
#include <new>

#include "bench/peak.h"

namespace gestus::bench {

using kernels::Isa;

std::vector<const kernels::KernelTable*> Tables() {
  std::vector<const kernels::KernelTable*> tables;
  for (const Isa isa : {Isa::kSse2, Isa::kNeon, Isa::kAvx2, Isa::kAvx512}) {
    if (const kernels::KernelTable* table = kernels::TableFor(isa)) tables.push_back(table);
  }
  return tables;
}

Data::Data(std::size_t size) : size_(size) {
  constexpr std::align_val_t kLine{64};
  data_ =
      static_cast<float*>(::operator new(std::max<std::size_t>(size, 1) * sizeof(float), kLine));
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < size; ++i) {
    state = state * 1664525u + 1013904223u;
    data_[i] = static_cast<float>(state >> 8) * 0x1p-23f - 1.0f;
  }
}

Data::~Data() { ::operator delete (data_, std::align_val_t{64}); }

const float* WeightRing::Next(std::size_t size) {
  static const Data ring(std::size_t{24} << 20);  // 96 MiB
  size = (size + 15) / 16 * 16;
  if (position_ + size > ring.size()) position_ = 0;
  position_ += size;
  return ring.get() + position_ - size;
}

void Report(benchmark::State& state, const Work& work, std::vector<double>& seconds) {
  if (seconds.empty()) return;
  std::sort(seconds.begin(), seconds.end());
  const double median = seconds[seconds.size() / 2];
  if (work.flops > 0.0) {
    const double rate = work.flops / median * 1e-9;
    const double peak = work.threads == 1 ? PeakGflops(work.isa) : PeakGflopsAllCores(work.isa);
    state.counters["GFLOP/s"] = rate;
    state.counters["peak_share"] = rate / peak;
    state.counters["best_share"] = work.flops / seconds.front() * 1e-9 / peak;
  }
  if (work.bytes > 0.0) state.counters["GB/s"] = work.bytes / median * 1e-9;
  state.counters["p50_us"] = median * 1e6;
}

}  // namespace gestus::bench
