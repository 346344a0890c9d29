// Says its instruction set and the instructions of its bf16 and int8 products ("-": none), then answers
// every line of standard input with one core's peaks at that moment: fp32, bf16, int8, in GOP/s.
#include <cstdio>

#include "bench/peak.h"

namespace gestus::bench {
namespace {

constexpr DotType kDots[] = {DotType::kBf16, DotType::kInt8};

void SayNames(const kernels::KernelTable& table) {
  std::printf("%s", table.name);
  for (const DotType type : kDots) {
    const char* name = PeakOfDots(table.isa, type).instruction;
    std::printf(" %s", *name != '\0' ? name : "-");
  }
  std::printf("\n");
  std::fflush(stdout);
}

void SayPeaks(const kernels::KernelTable& table) {
  std::printf("%.3f", PeakGflops(table.isa));
  for (const DotType type : kDots) std::printf(" %.3f", PeakOfDots(table.isa, type).gops);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace gestus::bench

int main() {
  const gestus::kernels::KernelTable& table = gestus::kernels::BestTable();
  gestus::bench::SayNames(table);
  for (int c; (c = std::getchar()) != EOF;)
    if (c == '\n') gestus::bench::SayPeaks(table);
  return 0;
}
