// Registers the kernel benchmarks for every instruction set that this machine has.  Selection and
// JSON by Google Benchmark's flags, e.g. --benchmark_filter=gemm/avx2 --benchmark_format=json.
#include <benchmark/benchmark.h>

#include "bench/kernels/common.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  gestus::bench::RegisterPeak();
  gestus::bench::RegisterGemm();
  gestus::bench::RegisterAttention();
  gestus::bench::RegisterLstm();
  gestus::bench::RegisterRows();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
