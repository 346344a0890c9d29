// Matrix products at the models' shapes, weights streamed from DRAM as in a whole network, with
// Eigen's at the same shapes; and the one-row product of autoregressive steps.
#include <omp.h>

#include <cmath>

#include "bench/kernels/common.h"
#include "bench/peak.h"

namespace gestus::bench {

#define GESTUS_DECLARE_EIGEN(isa)                                                                \
  void EigenGemm_##isa(float* out, const float* a, const float* w, std::size_t m, std::size_t n, \
                       std::size_t k, int threads);
GESTUS_DECLARE_EIGEN(sse2)
GESTUS_DECLARE_EIGEN(avx2)
GESTUS_DECLARE_EIGEN(avx512)
GESTUS_DECLARE_EIGEN(neon)
#undef GESTUS_DECLARE_EIGEN

namespace {

using kernels::Activation;
using kernels::GemmArgs;
using kernels::Isa;
using kernels::KernelTable;

struct Shape {
  std::size_t m, k, n;
  Activation act = Activation::kNone;
};

// AST: qkv, projection and the two layers of the perceptron, for 64 and 1024 frames; then the
// generator of ZS-MSTM 1.0.
const Shape kShapes[] = {
    {62, 768, 2304},
    {62, 768, 768},
    {62, 768, 3072, Activation::kGeluErf},
    {62, 3072, 768},
    {1214, 768, 2304},
    {1214, 768, 768},
    {1214, 768, 3072, Activation::kGeluErf},
    {1214, 3072, 768},
    {64, 3840, 768},
    {64, 1536, 4608},
    {64, 1536, 1536},
    {64, 768, 2048},
    {64, 2048, 768},
};

using EigenGemm = void (*)(float*, const float*, const float*, std::size_t, std::size_t,
                           std::size_t, int);

EigenGemm EigenFor(Isa isa) {
  switch (isa) {
#ifdef GESTUS_HAVE_SSE2
    case Isa::kSse2:
      return EigenGemm_sse2;
#endif
#ifdef GESTUS_HAVE_AVX2
    case Isa::kAvx2:
      return EigenGemm_avx2;
#endif
#ifdef GESTUS_HAVE_AVX512
    case Isa::kAvx512:
      return EigenGemm_avx512;
#endif
#ifdef GESTUS_HAVE_NEON
    case Isa::kNeon:
      return EigenGemm_neon;
#endif
    default:
      return nullptr;
  }
}

/// Compares the corners and the middle of a * w^T + bias with sums in double.
bool Right(const float* out, const float* a, const float* w, const float* bias, const Shape& s) {
  for (const std::size_t i : {std::size_t{0}, s.m / 2, s.m - 1}) {
    for (const std::size_t j : {std::size_t{0}, s.n / 2, s.n - 1}) {
      double want = bias != nullptr ? bias[j] : 0.0;
      for (std::size_t k = 0; k < s.k; ++k) want += double{a[i * s.k + k]} * w[j * s.k + k];
      if (!(std::fabs(want - out[i * s.n + j]) < 1e-6 * static_cast<double>(s.k))) return false;
    }
  }
  return true;
}

/// One call on all of the output, its columns divided among `threads`.
void Multiply(const KernelTable& table, bool one_row, GemmArgs args, int threads) {
  const auto kernel = one_row ? table.f32_gemv : table.f32_gemm;
  if (threads == 1) {
    kernel(args);
    return;
  }
  const std::size_t blocks = (args.n + table.gemm_block_n - 1) / table.gemm_block_n;
#pragma omp parallel num_threads(threads) firstprivate(args)
  {
    const auto me = static_cast<std::size_t>(omp_get_thread_num());
    const auto all = static_cast<std::size_t>(omp_get_num_threads());
    args.n_begin = blocks * me / all * table.gemm_block_n;
    args.n_end = me + 1 == all ? args.n : blocks * (me + 1) / all * table.gemm_block_n;
    kernel(args);
  }
}

double Flops(const Shape& s) { return 2.0 * static_cast<double>(s.m * s.n * s.k); }
double Bytes(const Shape& s) { return 4.0 * static_cast<double>(s.m * (s.n + s.k) + s.n * s.k); }

void OurGemm(benchmark::State& state, const KernelTable& table, const Shape& s, int threads) {
  const bool one_row = s.m == 1;
  const std::size_t packed_size = table.f32_gemm_packed_size(s.n, s.k);
  const Data a(s.m * s.k), w(s.n * s.k), bias(s.n), packed(packed_size), out(s.m * s.n);
  table.f32_gemm_pack(packed.get(), w.get(), static_cast<std::ptrdiff_t>(s.k), s.n, s.k);
  GemmArgs args;
  args.out = out.get();
  args.out_stride = static_cast<std::ptrdiff_t>(s.n);
  args.a = a.get();
  args.a_stride = static_cast<std::ptrdiff_t>(s.k);
  args.packed = packed.get();
  args.m = s.m, args.n = s.n, args.k = s.k, args.n_end = s.n;
  args.epilogue.bias = bias.get();
  Multiply(table, one_row, args, threads);
  if (!Right(out.get(), a.get(), w.get(), bias.get(), s))
    return state.SkipWithError("wrong result");
  args.epilogue.act = s.act;
  WeightRing ring;
  Measure(state, {table.isa, Flops(s), Bytes(s), threads}, [&] {
    args.packed = ring.Next(packed_size);
    Multiply(table, one_row, args, threads);
  });
}

void EigensGemm(benchmark::State& state, Isa isa, const Shape& s, int threads) {
  const EigenGemm gemm = EigenFor(isa);
  const Data a(s.m * s.k), w(s.n * s.k), out(s.m * s.n);
  gemm(out.get(), a.get(), w.get(), s.m, s.n, s.k, threads);
  if (!Right(out.get(), a.get(), w.get(), nullptr, s)) return state.SkipWithError("wrong result");
  WeightRing ring;
  Measure(state, {isa, Flops(s), Bytes(s), threads},
          [&] { gemm(out.get(), a.get(), ring.Next(s.n * s.k), s.m, s.n, s.k, threads); });
}

std::string Name(const char* kernel, const char* isa, const Shape& s, int threads) {
  std::string name = std::string(kernel) + "/" + isa + "/" + std::to_string(s.m) + "x" +
                     std::to_string(s.k) + "->" + std::to_string(s.n);
  if (s.act == Activation::kGeluErf) name += "+gelu";
  return threads == 1 ? name : name + "/threads:" + std::to_string(threads);
}

void RegisterShape(const KernelTable* table, const Shape& s, int threads) {
  Register(Name("f32_gemm", table->name, s, threads),
           [=](benchmark::State& state) { OurGemm(state, *table, s, threads); });
  Register(Name("eigen_gemm", table->name, {s.m, s.k, s.n}, threads),
           [=](benchmark::State& state) { EigensGemm(state, table->isa, s, threads); });
}

}  // namespace

void RegisterGemm() {
  const std::vector<const KernelTable*> tables = Tables();
  for (const KernelTable* table : tables) {
    const bool best = table == tables.back();
    for (const Shape& s : kShapes) {
      // The slow ISAs are there for comparison with each other: short inputs are enough.
      if (!best && s.m > 64) continue;
      RegisterShape(table, s, 1);
      if (best && s.k * s.n == 768 * 3072) RegisterShape(table, s, omp_get_num_procs());
      if (s.m != 1214) {
        const Shape row{1, s.k, s.n};
        Register(Name("f32_gemv", table->name, row, 1),
                 [=](benchmark::State& state) { OurGemm(state, *table, row, 1); });
      }
    }
  }
}

}  // namespace gestus::bench
