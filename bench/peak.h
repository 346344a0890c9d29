// The limits of this machine, measured in the process that measures the kernels: multiply-add peak
// per instruction set and read bandwidth.  Rates on a shared machine mean little; shares of these
// do.
#ifndef GESTUS_BENCH_PEAK_H_
#define GESTUS_BENCH_PEAK_H_

#include <cstddef>

#include "kernels/kernels.h"

namespace gestus::bench {

/// GFLOP/s of independent multiply-adds (on SSE2: multiplications and additions) in registers, on
/// one core.  The best of several short runs, measured anew by each call (a few milliseconds).
double PeakGflops(kernels::Isa isa);

/// Narrow numbers that some instruction sets multiply faster than float32.
enum class DotType { kBf16, kInt8 };

struct DotPeak {
  const char* instruction;  ///< empty where the instruction set has none
  double gops;              ///< as PeakGflops
};
/// The dot products of `isa`; of AMX those of its vectors, not of its tiles.
DotPeak PeakOfDots(kernels::Isa isa, DotType type);

/// The same as PeakGflops on all cores at once, the best of all calls so far.
double PeakGflopsAllCores(kernels::Isa isa);

/// GB/s of reading `bytes` again and again on one core; more than the L3 cache for that of DRAM.
double ReadGbps(kernels::Isa isa, std::size_t bytes);

}  // namespace gestus::bench

#endif  // GESTUS_BENCH_PEAK_H_
