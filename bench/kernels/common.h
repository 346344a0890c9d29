// What the kernel benchmarks share: random data, the ring of weights, and a loop that times every
// call so that medians and shares of the machine's peak can be stated.
#ifndef GESTUS_BENCH_KERNELS_COMMON_H_
#define GESTUS_BENCH_KERNELS_COMMON_H_

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "kernels/kernels.h"

namespace gestus::bench {

/// The tables that this machine runs, the scalar one aside.
std::vector<const kernels::KernelTable*> Tables();

/// Floats in [-1, 1) with the memory's own lifetime, aligned to 64 bytes.
class Data {
 public:
  explicit Data(std::size_t size);
  ~Data();
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  float* get() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  float* data_;
  std::size_t size_;
};

/// Random numbers of three times the size of a large L3 cache.  A benchmark that takes its packed
/// weights from here piece after piece finds them in DRAM, as the layers of a network do.
class WeightRing {
 public:
  /// The next `size` floats, which must be fewer than the ring has.
  const float* Next(std::size_t size);

 private:
  std::size_t position_ = 0;
};

/// Sets the counters of a benchmark from the time of the median call.
struct Work {
  kernels::Isa isa;
  double flops = 0.0;  ///< per call; 0 when the rate of operations says nothing
  double bytes = 0.0;  ///< per call, read and written
  int threads = 1;
};
void Report(benchmark::State& state, const Work& work, std::vector<double>& seconds);

/// Runs f until the benchmark has enough of it.
template <class F>
void Measure(benchmark::State& state, const Work& work, const F& f) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds;
  for (auto _ : state) {
    const Clock::time_point start = Clock::now();
    f();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    state.SetIterationTime(seconds.back());
  }
  Report(state, work, seconds);
}

/// Registers under "kernel/isa/shape" with the settings all kernel benchmarks share.
template <class F>
void Register(const std::string& name, const F& f) {
  benchmark::RegisterBenchmark(name.c_str(), f)
      ->UseManualTime()
      ->MinTime(0.15)
      ->Unit(benchmark::kMicrosecond);
}

void RegisterPeak();
void RegisterGemm();
void RegisterAttention();
void RegisterLstm();
void RegisterRows();

}  // namespace gestus::bench

#endif  // GESTUS_BENCH_KERNELS_COMMON_H_
