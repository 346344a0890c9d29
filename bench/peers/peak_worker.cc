// Answers every line of standard input with one core's fp32 peak at that moment, in GFLOP/s.
#include <cstdio>

#include "bench/peak.h"

int main() {
  const gestus::kernels::KernelTable& table = gestus::kernels::BestTable();
  std::printf("%s\n", table.name);
  std::fflush(stdout);
  for (int c; (c = std::getchar()) != EOF;) {
    if (c != '\n') continue;
    std::printf("%.3f\n", gestus::bench::PeakGflops(table.isa));
    std::fflush(stdout);
  }
  return 0;
}
