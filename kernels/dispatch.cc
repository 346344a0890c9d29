// Which table of kernels this machine runs: asked once, of the CPU (CPUID) and of the operating
// system (XGETBV: are the wide registers saved at a context switch?).
#include <atomic>
#include <cstdlib>
#include <cstring>

#include "kernels/isa/tables.h"
#include "kernels/kernels.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace gestus::kernels {
namespace {

constexpr const char* kNames[] = {"scalar", "sse2", "neon", "avx2", "avx512"};
// From the best to the least; the scalar table always runs.
constexpr Isa kLadder[] = {Isa::kAvx512, Isa::kAvx2, Isa::kNeon, Isa::kSse2, Isa::kScalar};

constexpr unsigned BitOf(Isa isa) { return 1u << static_cast<unsigned>(isa); }

#if defined(__x86_64__)
constexpr bool HasAll(unsigned word, unsigned bits) { return (word & bits) == bits; }

/// The register sets that the operating system saves (XCR0).
unsigned SavedRegisters() {
  unsigned low = 0, high = 0;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

unsigned AskMachine() {
  constexpr unsigned kAvxState = 0x06, kAvx512State = 0xe6;
  unsigned isas = BitOf(Isa::kScalar) | BitOf(Isa::kSse2);
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0) return isas;
  if (!HasAll(c, bit_OSXSAVE | bit_AVX | bit_FMA)) return isas;
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0) return isas;
  const unsigned saved = SavedRegisters();
  if (!HasAll(saved, kAvxState) || !HasAll(b, bit_AVX2)) return isas;
  isas |= BitOf(Isa::kAvx2);
  constexpr unsigned kAvx512Bits =
      bit_AVX512F | bit_AVX512DQ | bit_AVX512CD | bit_AVX512BW | bit_AVX512VL;
  if (HasAll(saved, kAvx512State) && HasAll(b, kAvx512Bits)) isas |= BitOf(Isa::kAvx512);
  return isas;
}
#elif defined(__aarch64__)
// NEON is part of the AArch64 baseline.
unsigned AskMachine() { return BitOf(Isa::kScalar) | BitOf(Isa::kNeon); }
#else
unsigned AskMachine() { return BitOf(Isa::kScalar); }
#endif

/// The machine's ISAs as bits.  Threads that ask first at the same time find the same answer.
unsigned MachineIsas() {
  static constinit std::atomic<unsigned> known{0};
  unsigned isas = known.load(std::memory_order_relaxed);
  if (isas == 0) {
    isas = AskMachine();
    known.store(isas, std::memory_order_relaxed);
  }
  return isas;
}

/// The table that was built into this binary, or null.
const KernelTable* BuiltTable(Isa isa) {
  switch (isa) {
    case Isa::kScalar:
      return &kScalarTable;
#if defined(GESTUS_HAVE_SSE2)
    case Isa::kSse2:
      return &kSse2Table;
#endif
#if defined(GESTUS_HAVE_NEON)
    case Isa::kNeon:
      return &kNeonTable;
#endif
#if defined(GESTUS_HAVE_AVX2)
    case Isa::kAvx2:
      return &kAvx2Table;
#endif
#if defined(GESTUS_HAVE_AVX512)
    case Isa::kAvx512:
      return &kAvx512Table;
#endif
    default:
      return nullptr;
  }
}

const KernelTable* Choose() {
  Isa wanted = Isa::kScalar;
  const char* lowered = std::getenv("GESTUS_ISA");
  if (lowered != nullptr && ParseIsa(lowered, &wanted)) {
    if (const KernelTable* table = TableFor(wanted)) return table;
  }
  for (const Isa isa : kLadder) {
    if (const KernelTable* table = TableFor(isa)) return table;
  }
  return &kScalarTable;
}

}  // namespace

const KernelTable* TableFor(Isa isa) {
  return (MachineIsas() & BitOf(isa)) != 0 ? BuiltTable(isa) : nullptr;
}

const KernelTable& BestTable() {
  static constinit std::atomic<const KernelTable*> chosen{nullptr};
  const KernelTable* table = chosen.load(std::memory_order_relaxed);
  if (table != nullptr) return *table;
  // Of threads that choose at the same time the first wins, so that all of the process agrees even
  // while somebody changes the environment.
  const KernelTable* mine = Choose();
  if (chosen.compare_exchange_strong(table, mine, std::memory_order_relaxed)) return *mine;
  return *table;
}

const char* IsaName(Isa isa) { return kNames[static_cast<unsigned>(isa)]; }

bool ParseIsa(const char* name, Isa* isa) {
  for (const Isa candidate : kLadder) {
    if (std::strcmp(name, IsaName(candidate)) == 0) {
      *isa = candidate;
      return true;
    }
  }
  return false;
}

}  // namespace gestus::kernels
