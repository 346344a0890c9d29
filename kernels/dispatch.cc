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
#if defined(__x86_64__) && defined(__linux__)
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace gestus::kernels {
namespace {

constexpr const char* kNames[] = {"scalar", "sse2",        "neon",        "avx2",
                                  "avx512", "avx512_vnni", "avx512_bf16", "avx512_amx"};
// From the best to the least; the scalar table always runs.
constexpr Isa kLadder[] = {Isa::kAvx512Amx, Isa::kAvx512Bf16, Isa::kAvx512Vnni, Isa::kAvx512,
                           Isa::kAvx2,      Isa::kNeon,       Isa::kSse2,       Isa::kScalar};

constexpr unsigned BitOf(Isa isa) { return 1u << static_cast<unsigned>(isa); }

#if defined(__x86_64__)
constexpr bool HasAll(unsigned word, unsigned bits) { return (word & bits) == bits; }

/// The register sets that the operating system saves (XCR0).
unsigned SavedRegisters() {
  unsigned low = 0, high = 0;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

/// Linux saves tiles only for processes that ask for it.  It refuses when a thread's alternate
/// signal stack is too small for them.
bool MayUseTiles() {
#if defined(__linux__) && defined(SYS_arch_prctl)
  constexpr int kRequestPermission = 0x1023, kTileData = 18;
  return syscall(SYS_arch_prctl, kRequestPermission, kTileData) == 0;
#else
  return false;
#endif
}

/// What CPUID's leaf 7 says of products of 8 and 16 bits, on a machine that has AVX-512.
unsigned AskForProducts(unsigned c, unsigned d, unsigned saved) {
  constexpr unsigned kVnni = 1u << 11, kBf16 = 1u << 5;  // ECX; EAX of 7.1
  constexpr unsigned kAmx = 1u << 22 | 1u << 24 | 1u << 25, kTileState = 0x60000;  // EDX; XCR0
  if (!HasAll(c, kVnni)) return 0;
  unsigned isas = BitOf(Isa::kAvx512Vnni), a = 0, rest[3];
  if (__get_cpuid_count(7, 1, &a, &rest[0], &rest[1], &rest[2]) == 0 || !HasAll(a, kBf16))
    return isas;
  isas |= BitOf(Isa::kAvx512Bf16);
  if (HasAll(d, kAmx) && HasAll(saved, kTileState) && MayUseTiles()) isas |= BitOf(Isa::kAvx512Amx);
  return isas;
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
  if (HasAll(saved, kAvx512State) && HasAll(b, kAvx512Bits))
    isas |= BitOf(Isa::kAvx512) | AskForProducts(c, d, saved);
  return isas;
}

/// Intel's cores do one vdpbf16ps every other cycle, half the work of their float32 multiply-adds
/// (measured on Sapphire Rapids: 118 against 230 GFLOP/s), so that widening is faster there.
bool SlowBf16() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(0, &a, &b, &c, &d) != 0 && b == signature_INTEL_ebx;
}
#elif defined(__aarch64__)
// NEON is part of the AArch64 baseline.
unsigned AskMachine() { return BitOf(Isa::kScalar) | BitOf(Isa::kNeon); }
bool SlowBf16() { return false; }
#else
unsigned AskMachine() { return BitOf(Isa::kScalar); }
bool SlowBf16() { return false; }
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

#if defined(GESTUS_HAVE_AVX512)
/// AVX-512's table with other products.  Tables of constants cannot be made of one another's
/// members before the program runs, so these are made when they are first asked for.
KernelTable With(Isa isa, const ProductKernels* bf16, const ProductKernels* i8) {
  KernelTable table = kAvx512Table;
  table.isa = isa;
  table.name = IsaName(isa);
  table.bf16 = bf16;
  table.i8 = i8;
  return table;
}

const KernelTable* Avx512Table(Isa isa) {
  static const KernelTable vnni = With(Isa::kAvx512Vnni, kAvx512Table.bf16, &kVnniI8Products);
  static const KernelTable bf16 = With(Isa::kAvx512Bf16, &kNativeBf16Products, &kVnniI8Products);
  static const KernelTable amx = With(Isa::kAvx512Amx, &kAmxBf16Products, &kAmxI8Products);
  return isa == Isa::kAvx512Vnni ? &vnni : isa == Isa::kAvx512Bf16 ? &bf16 : &amx;
}
#endif

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
    case Isa::kAvx512Vnni:
    case Isa::kAvx512Bf16:
    case Isa::kAvx512Amx:
      return Avx512Table(isa);
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
    if (isa == Isa::kAvx512Bf16 && SlowBf16()) continue;
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
