// The matrix product and its one-row form: awkward and real shapes, every epilogue, overlapping
// rows, and the promise that an element's bits do not depend on how M and N were divided.
#include <cstring>

#include "tests/kernels/packed.h"

namespace gestus::test {
namespace {

using kernels::GemmArgs;
using kernels::KernelTable;

struct Problem {
  std::size_t m, n, k;
  Activation act = Activation::kNone;
  bool bias = false, residual = false, one_residual_row = false;
  std::size_t gap = 0;
};

struct Operands {
  Matrix a, w, bias, residual;
  Operands(const Problem& p, std::uint32_t seed)
      : a(Matrix::Random(p.m, p.k, p.gap, seed)),
        w(Matrix::Random(p.n, p.k, p.gap, seed + 1)),
        bias(Matrix::Random(1, p.n, 0, seed + 2)),
        residual(Matrix::Random(p.one_residual_row ? 1 : p.m, p.n, p.gap, seed + 3)) {}
};

GemmArgs ArgsOf(const Problem& p, const Operands& o, const float* packed, Matrix* out) {
  GemmArgs args;
  args.out = out->data();
  args.out_stride = out->stride();
  args.a = o.a.data();
  args.a_stride = o.a.stride();
  args.packed = packed;
  args.m = p.m;
  args.n = p.n;
  args.k = p.k;
  args.n_end = p.n;
  args.epilogue.act = p.act;
  args.epilogue.alpha = 0.2f;
  if (p.bias) args.epilogue.bias = o.bias.data();
  if (p.residual) {
    args.epilogue.residual = o.residual.data();
    args.epilogue.residual_stride = p.one_residual_row ? 0 : o.residual.stride();
  }
  return args;
}

Tolerance ToleranceOf(const Problem& p) {
  const double product = GemmTolerance(p.k, 1.0, 1.0);
  return [p, product](std::size_t, std::size_t, double want) {
    // |argument| <= k + 1 is far more than uniform numbers reach; the result bounds it better.
    const double size = std::fabs(want) + 2.0;
    return ActivationSlope(p.act) * (product + kEps * size) +
           ActivationTolerance(p.act, size, size) + kEps * size;
  };
}

void Check(const KernelTable& table, const KernelTable& reference, const Problem& p,
           std::uint32_t seed) {
  SCOPED_TRACE(::testing::Message() << "m " << p.m << " n " << p.n << " k " << p.k << " act "
                                    << static_cast<int>(p.act));
  const Operands o(p, seed);
  Matrix want(p.m, p.n), got(p.m, p.n, p.gap);
  want.set_seed(seed);
  const GuardedFloats plain = PackGemm(reference, o.w), packed = PackGemm(table, o.w);
  reference.f32_gemm(ArgsOf(p, o, plain.data(), &want));
  table.f32_gemm(ArgsOf(p, o, packed.data(), &got));
  ASSERT_TRUE(Close(got, want, ToleranceOf(p)));
  if (p.m != 1) return;
  Matrix row(1, p.n);
  table.f32_gemv(ArgsOf(p, o, packed.data(), &row));
  ASSERT_TRUE(Close(row, want, ToleranceOf(p))) << "of gemv";
}

class GemmTest : public KernelTest {};
GESTUS_TEST_ON_EVERY_ISA(GemmTest);

// A product that anybody can check in the head: the reference itself must get it right.
TEST_P(GemmTest, KnownProduct) {
  Matrix a(2, 3), w(2, 3), got(2, 2);
  const float values[] = {1, 2, 3, 4, 5, 6};
  std::memcpy(a.data(), values, sizeof(values));
  const float weights[] = {1, 0, -1, 0.5f, 0.5f, 0.5f};
  std::memcpy(w.data(), weights, sizeof(weights));
  const GuardedFloats packed = PackGemm(*table_, w);
  GemmArgs args;
  args.out = got.data();
  args.out_stride = got.stride();
  args.a = a.data();
  args.a_stride = a.stride();
  args.packed = packed.data();
  args.m = args.n = args.n_end = 2;
  args.k = 3;
  args.epilogue.act = Activation::kRelu;
  const float bias[] = {0.5f, 1.0f}, residual[] = {10, 20};
  args.epilogue.bias = bias;
  args.epilogue.residual = residual;
  table_->f32_gemm(args);
  // relu(-2 + 0.5) + 10, relu(3 + 1) + 20, ...
  EXPECT_EQ(got(0, 0), 10.0f);
  EXPECT_EQ(got(0, 1), 24.0f);
  EXPECT_EQ(got(1, 0), 10.0f);
  EXPECT_EQ(got(1, 1), 28.5f);
}

TEST_P(GemmTest, AwkwardSizes) {
  std::uint32_t seed = 1;
  for (const std::size_t n : AwkwardSizes()) Check(*table_, *reference_, {5, n, 19}, ++seed);
  for (const std::size_t k : AwkwardSizes()) Check(*table_, *reference_, {3, 18, k}, ++seed);
  for (std::size_t m = 1; m <= 31; ++m) Check(*table_, *reference_, {m, 33, 20}, ++seed);
  for (const std::size_t m : {61, 113}) Check(*table_, *reference_, {m, 67, 127}, ++seed);
}

TEST_P(GemmTest, RealShapes) {
  const Problem shapes[] = {
      {62, 3072, 768, Activation::kGeluErf, true},
      {62, 768, 3072, Activation::kNone, true, true},
      {1, 2304, 768, Activation::kNone, true},
      {1, 768, 3072, Activation::kNone, true, true},
      {64, 384, 384, Activation::kNone, true},
      {62, 768, 256, Activation::kNone, true, true, true},
  };
  std::uint32_t seed = 100;
  for (const Problem& p : shapes) Check(*table_, *reference_, p, ++seed);
}

TEST_P(GemmTest, EveryEpilogueWithStridesAndUnalignedStarts) {
  std::uint32_t seed = 200;
  for (int act = 0; act <= static_cast<int>(Activation::kSigmoid); ++act) {
    for (int mask = 0; mask < 8; ++mask) {
      for (const std::size_t m : {1, 9}) {
        Problem p{m, 37, 29, static_cast<Activation>(act)};
        p.bias = (mask & 1) != 0;
        p.residual = (mask & 2) != 0;
        p.one_residual_row = (mask & 4) != 0;
        p.gap = 3;
        Check(*table_, *reference_, p, ++seed);
      }
    }
  }
}

// conv1d multiplies rows that overlap: row i + 1 starts before row i ends.
TEST_P(GemmTest, OverlappingRows) {
  constexpr std::size_t kRows = 21, kIn = 7, kKernel = 3, kOut = 19, kK = kIn * kKernel;
  const Matrix x = Matrix::Random(kRows + kKernel - 1, kIn, 0, 7);
  const Matrix w = Matrix::Random(kOut, kK, 0, 8);
  Matrix want(kRows, kOut), got(kRows, kOut, 5);
  const GuardedFloats plain = PackGemm(*reference_, w), packed = PackGemm(*table_, w);
  GemmArgs args;
  args.a = x.data();
  args.a_stride = kIn;
  args.m = kRows;
  args.n = args.n_end = kOut;
  args.k = kK;
  args.out = want.data();
  args.out_stride = want.stride();
  args.packed = plain.data();
  reference_->f32_gemm(args);
  args.out = got.data();
  args.out_stride = got.stride();
  args.packed = packed.data();
  table_->f32_gemm(args);
  EXPECT_TRUE(Close(got, want, ToleranceOf({kRows, kOut, kK})));
}

// One row against a stride of zero: every output row is the same product.
TEST_P(GemmTest, RepeatedRow) {
  const Matrix x = Matrix::Random(1, 24, 0, 9), w = Matrix::Random(10, 24, 0, 10);
  const GuardedFloats packed = PackGemm(*table_, w);
  Matrix got(8, 10);
  GemmArgs args;
  args.a = x.data();
  args.m = 8;
  args.n = args.n_end = 10;
  args.k = 24;
  args.out = got.data();
  args.out_stride = got.stride();
  args.packed = packed.data();
  table_->f32_gemm(args);
  for (std::size_t i = 1; i < 8; ++i) {
    EXPECT_EQ(std::memcmp(&got(0, 0), &got(i, 0), 10 * sizeof(float)), 0);
  }
}

TEST_P(GemmTest, BitsDoNotDependOnTheDivision) {
  const Problem p{62, 203, 771, Activation::kGeluErf, true, true};
  const Operands o(p, 11);
  const GuardedFloats packed = PackGemm(*table_, o.w);
  Matrix whole(p.m, p.n);
  table_->f32_gemm(ArgsOf(p, o, packed.data(), &whole));
  const std::size_t block = table_->gemm_block_n;
  for (const std::size_t blocks_at_once : {1, 2, 5}) {
    for (const std::size_t rows_at_once : {2, 3, 7, 13, 20, 31}) {
      Matrix parts(p.m, p.n);
      for (std::size_t n = 0; n < p.n; n += blocks_at_once * block) {
        for (std::size_t m = 0; m < p.m;) {
          // No piece of one row: that one may be summed differently.
          const std::size_t left = p.m - m;
          const std::size_t rows = left <= rows_at_once + 1 ? left : rows_at_once;
          GemmArgs args = ArgsOf(p, o, packed.data(), &parts);
          args.out += m * p.n;
          args.a += m * p.k;
          args.epilogue.residual += m * p.n;
          args.m = rows;
          args.n_begin = n;
          args.n_end = std::min(p.n, n + blocks_at_once * block);
          table_->f32_gemm(args);
          m += rows;
        }
      }
      ASSERT_EQ(std::memcmp(parts.data(), whole.data(), p.m * p.n * sizeof(float)), 0)
          << blocks_at_once << " blocks, " << rows_at_once << " rows at once";
    }
  }
}

TEST_P(GemmTest, GemvBitsDoNotDependOnTheDivision) {
  const Problem p{1, 203, 771, Activation::kTanh, true, true};
  const Operands o(p, 12);
  const GuardedFloats packed = PackGemm(*table_, o.w);
  Matrix whole(1, p.n), parts(1, p.n);
  table_->f32_gemv(ArgsOf(p, o, packed.data(), &whole));
  const std::size_t block = table_->gemm_block_n;
  for (std::size_t n = 0; n < p.n; n += block) {
    GemmArgs args = ArgsOf(p, o, packed.data(), &parts);
    args.n_begin = n;
    args.n_end = std::min(p.n, n + block);
    table_->f32_gemv(args);
  }
  EXPECT_EQ(std::memcmp(parts.data(), whole.data(), p.n * sizeof(float)), 0);
}

// Only the wanted columns may be written.
TEST_P(GemmTest, ColumnRangeLeavesTheRest) {
  const Problem p{5, 4 * table_->gemm_block_n, 16};
  const Operands o(p, 13);
  const GuardedFloats packed = PackGemm(*table_, o.w);
  Matrix got(p.m, p.n);
  got.Fill(77.0f);
  GemmArgs args = ArgsOf(p, o, packed.data(), &got);
  args.n_begin = table_->gemm_block_n;
  args.n_end = 2 * table_->gemm_block_n;
  table_->f32_gemm(args);
  for (std::size_t i = 0; i < p.m; ++i) {
    for (std::size_t j = 0; j < p.n; ++j) {
      const bool wanted = j >= args.n_begin && j < args.n_end;
      EXPECT_EQ(got(i, j) == 77.0f, !wanted) << i << ", " << j;
    }
  }
}

TEST_P(GemmTest, SpecialValues) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const std::size_t m : {1, 4}) {
    const Problem p{m, 20, 9};
    Operands o(p, 14);
    o.w.Fill(1.0f);
    o.a.Fill(-0.0f);
    o.a(m - 1, 8) = kInf;
    o.w(3, 8) = -1.0f;
    o.w(19, 0) = kNan;
    const GuardedFloats packed = PackGemm(*table_, o.w);
    Matrix got(m, p.n);
    table_->f32_gemm(ArgsOf(p, o, packed.data(), &got));
    EXPECT_EQ(got(m - 1, 0), kInf);
    EXPECT_EQ(got(m - 1, 3), -kInf);
    EXPECT_TRUE(std::isnan(got(m - 1, 19)));
    if (m > 1) {
      EXPECT_EQ(got(0, 0), 0.0f);
    }
  }
}

}  // namespace
}  // namespace gestus::test
