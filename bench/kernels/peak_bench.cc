// The machine's own limits, so that they stand beside the kernels in every report.
#include "bench/kernels/common.h"
#include "bench/peak.h"

namespace gestus::bench {

void RegisterPeak() {
  for (const kernels::KernelTable* table : Tables()) {
    const std::string name = std::string("peak/") + table->name;
    const auto once = [](const std::string& row, const char* counter, auto measure) {
      benchmark::RegisterBenchmark(row.c_str(), [=](benchmark::State& state) {
        double best = 0.0;
        for (auto _ : state) best = measure();
        state.counters[counter] = best;
      })->Iterations(1);
    };
    const kernels::Isa isa = table->isa;
    once(name + "/multiply_add", "GFLOP/s", [isa] { return PeakGflops(isa); });
    once(name + "/multiply_add/all_cores", "GFLOP/s", [isa] { return PeakGflopsAllCores(isa); });
    once(name + "/read/L1", "GB/s", [isa] { return ReadGbps(isa, std::size_t{16} << 10); });
    once(name + "/read/L2", "GB/s", [isa] { return ReadGbps(isa, std::size_t{256} << 10); });
    once(name + "/read/L3", "GB/s", [isa] { return ReadGbps(isa, std::size_t{8} << 20); });
    once(name + "/read/DRAM", "GB/s", [isa] { return ReadGbps(isa, std::size_t{128} << 20); });
  }
}

}  // namespace gestus::bench
