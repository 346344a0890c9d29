// Products with bf16 and 8-bit weights: awkward and real shapes, every epilogue, whole numbers that
// must come out exact, rows that are not finite, and bits that do not depend on the division.
#include <algorithm>

#include "tests/kernels/typed_weights.h"

namespace gestus::test {
namespace {

using kernels::GemmArgs;
using kernels::ProductKernels;

struct Problem {
  std::size_t m, n, k;
  Activation act = Activation::kNone;
  bool bias = false, residual = false;
  std::size_t gap = 0;
};

struct Operands {
  TypedWeights w;
  Matrix a, bias, residual;
  // bf16: rows that rounding leaves alone, so that all machines multiply the same numbers.
  Operands(Type type, const Problem& p, std::uint32_t seed)
      : w(type, p.n, p.k, seed + 1),
        a(type == Type::kBf16 ? RoundToBf16(Matrix::Random(p.m, p.k, p.gap, seed))
                              : Matrix::Random(p.m, p.k, p.gap, seed)),
        bias(Matrix::Random(1, p.n, 0, seed + 2)),
        residual(Matrix::Random(p.m, p.n, p.gap, seed + 3)) {}
};

GemmArgs ArgsOf(const Problem& p, const Operands& o, const GuardedFloats& packed, Matrix* out,
                GuardedFloats* scratch) {
  GemmArgs args;
  args.out = out->data();
  args.out_stride = out->stride();
  args.a = o.a.data();
  args.a_stride = o.a.stride();
  args.packed = packed.data();
  args.m = p.m;
  args.n = args.n_end = p.n;
  args.k = p.k;
  args.epilogue.act = p.act;
  args.epilogue.alpha = 0.2f;
  if (p.bias) args.epilogue.bias = o.bias.data();
  if (p.residual) {
    args.epilogue.residual = o.residual.data();
    args.epilogue.residual_stride = o.residual.stride();
  }
  args.scratch = scratch->data();
  return args;
}

bool Polynomial(Activation act) {
  return act != Activation::kNone && act != Activation::kRelu && act != Activation::kLeakyRelu;
}

/// i8 without an activation made of polynomials: no error at all.
Tolerance ToleranceOf(Type type, const Problem& p) {
  const bool exact = type == Type::kI8;
  const double product = exact ? 0.0 : GemmTolerance(p.k, 1.0, 1.0);
  return [=](std::size_t, std::size_t, double want) {
    if (exact && !Polynomial(p.act)) return 0.0;
    const double size = std::fabs(want) + 2.0;
    return ActivationSlope(p.act) * (product + kEps * size) +
           ActivationTolerance(p.act, size, size) + kEps * size;
  };
}

class TypedGemmTest : public TypedTest {
 protected:
  void Check(const Problem& p, std::uint32_t seed) {
    SCOPED_TRACE(::testing::Message() << "m " << p.m << " n " << p.n << " k " << p.k << " act "
                                      << static_cast<int>(p.act));
    const Operands o(type(), p, seed);
    Matrix want(p.m, p.n), got(p.m, p.n, p.gap);
    want.set_seed(seed);
    const GuardedFloats plain = PackTyped(*reference_, o.w), packed = PackTyped(*table_, o.w);
    GuardedFloats plain_scratch = GuardedBytes(reference().scratch(p.m, p.k));
    GuardedFloats scratch = GuardedBytes(products().scratch(p.m, p.k));
    reference().gemm(ArgsOf(p, o, plain, &want, &plain_scratch));
    products().gemm(ArgsOf(p, o, packed, &got, &scratch));
    ASSERT_TRUE(Close(got, want, ToleranceOf(type(), p)));
    if (p.m != 1) return;
    Matrix row(1, p.n);
    products().gemv(ArgsOf(p, o, packed, &row, &scratch));
    ASSERT_TRUE(Close(row, want, ToleranceOf(type(), p))) << "of gemv";
  }
};
GESTUS_TEST_EVERY_TYPE_ON_EVERY_ISA(TypedGemmTest);

TEST_P(TypedGemmTest, AwkwardSizes) {
  std::uint32_t seed = 1;
  for (const std::size_t n : AwkwardSizes()) Check({5, n, 19}, ++seed);
  for (const std::size_t k : AwkwardSizes()) Check({3, 18, k}, ++seed);
  for (const std::size_t k : AwkwardSizes()) Check({1, 35, k}, ++seed);
  for (std::size_t m = 1; m <= 35; ++m) Check({m, 33, 20}, ++seed);
  for (const std::size_t m : {61, 113, 200}) Check({m, 67, 127}, ++seed);
}

TEST_P(TypedGemmTest, RealShapes) {
  const Problem shapes[] = {
      {62, 768, 768, Activation::kGeluErf, true}, {62, 192, 3072, Activation::kNone, true, true},
      {1, 2304, 768, Activation::kNone, true},    {1, 256, 3072, Activation::kNone, true, true},
      {64, 384, 384, Activation::kNone, true},
  };
  std::uint32_t seed = 100;
  for (const Problem& p : shapes) Check(p, ++seed);
}

TEST_P(TypedGemmTest, EveryEpilogueWithStridesAndUnalignedStarts) {
  std::uint32_t seed = 200;
  for (int act = 0; act <= static_cast<int>(Activation::kSigmoid); ++act) {
    for (int mask = 0; mask < 4; ++mask) {
      for (const std::size_t m : {1, 9, 33}) {
        Problem p{m, 37, 29, static_cast<Activation>(act)};
        p.bias = (mask & 1) != 0;
        p.residual = (mask & 2) != 0;
        p.gap = 3;
        Check(p, ++seed);
      }
    }
  }
}

// What rounding the rows to bf16 may add: each product is off by 2^-9, half the distance of two
// bf16.
TEST_P(TypedGemmTest, RowsThatRoundingChanges) {
  if (type() != Type::kBf16) GTEST_SKIP() << "only bf16 rounds";
  for (const std::size_t m : {1, 4, 40}) {
    const Problem p{m, 45, 333};
    Operands o(type(), p, 300);
    o.a = Matrix::Random(p.m, p.k, 0, 301);
    Matrix want(p.m, p.n), got(p.m, p.n);
    const GuardedFloats plain = PackTyped(*reference_, o.w), packed = PackTyped(*table_, o.w);
    GuardedFloats scratch = GuardedBytes(products().scratch(p.m, p.k)), none = GuardedBytes(0);
    reference().gemm(ArgsOf(p, o, plain, &want, &none));
    products().gemm(ArgsOf(p, o, packed, &got, &scratch));
    const double product = GemmTolerance(p.k, 1.0, 1.0);
    EXPECT_TRUE(Close(got, want, [&](std::size_t i, std::size_t j, double) {
      double sum = 0;
      for (std::size_t k = 0; k < p.k; ++k) sum += std::fabs(double{o.a(i, k)} * o.w(j, k));
      return sum * 0x1p-9 + product;
    }));
  }
}

// Rows of whole numbers whose largest is 127 are their own quantisation: 10 million products of
// random and of extreme numbers, compared with sums of 64-bit integers.
TEST_P(TypedGemmTest, WholeNumbersAreExact) {
  if (type() != Type::kI8) GTEST_SKIP() << "of 8-bit weights";
  constexpr std::size_t kM = 20, kN = 500, kK = 1001;
  std::mt19937 generator(7);
  for (const int kind : {0, 1, 2}) {
    const auto draw = [&]() -> int {
      if (kind == 0) return static_cast<int>(generator() % 255) - 127;
      if (kind == 1) return generator() % 2 == 0 ? 127 : -127;
      return 127;
    };
    const Problem p{kM, kN, kK};
    Operands o(type(), p, 8);
    std::fill(o.w.scale.begin(), o.w.scale.end(), 1.0f);
    for (auto& w : o.w.i8) w = static_cast<std::int8_t>(draw());
    for (std::size_t i = 0; i < kM; ++i) {
      for (std::size_t j = 0; j < kK; ++j) o.a(i, j) = static_cast<float>(draw());
      o.a(i, i) = kind == 2 ? -127.0f : 127.0f;
    }
    Matrix got(kM, kN), row(1, kN);
    const GuardedFloats packed = PackTyped(*table_, o.w);
    GuardedFloats scratch = GuardedBytes(products().scratch(kM, kK));
    products().gemm(ArgsOf(p, o, packed, &got, &scratch));
    GemmArgs first = ArgsOf(p, o, packed, &row, &scratch);
    first.m = 1;
    products().gemv(first);
    for (std::size_t i = 0; i < kM; ++i) {
      for (std::size_t j = 0; j < kN; ++j) {
        std::int64_t sum = 0;
        for (std::size_t k = 0; k < kK; ++k)
          sum += static_cast<std::int64_t>(o.a(i, k)) * o.w.i8[j * kK + k];
        ASSERT_EQ(got(i, j), static_cast<float>(sum)) << kind << ": " << i << ", " << j;
        if (i == 0) {
          ASSERT_EQ(row(0, j), static_cast<float>(sum)) << kind << ": gemv " << j;
        }
      }
    }
  }
}

// The longest row that a file may hold, at its worst.
TEST_P(TypedGemmTest, LongestRowDoesNotOverflow) {
  if (type() != Type::kI8) GTEST_SKIP() << "of 8-bit weights";
  const Problem p{3, 2, kernels::kMaxI8Depth};
  Operands o(type(), p, 9);
  std::fill(o.w.scale.begin(), o.w.scale.end(), 1.0f);
  std::fill(o.w.i8.begin(), o.w.i8.end(), std::int8_t{127});
  o.a.Fill(127.0f);
  for (std::size_t k = 0; k < p.k; ++k) o.a(1, k) = -127.0f;
  Matrix got(p.m, p.n);
  const GuardedFloats packed = PackTyped(*table_, o.w);
  GuardedFloats scratch = GuardedBytes(products().scratch(p.m, p.k));
  products().gemm(ArgsOf(p, o, packed, &got, &scratch));
  const auto want = static_cast<float>(127 * 127 * static_cast<std::int64_t>(p.k));
  EXPECT_EQ(got(0, 1), want);
  EXPECT_EQ(got(1, 1), -want);
}

TEST_P(TypedGemmTest, SpecialRows) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const Problem p{6, 20, 37};
  Operands o(type(), p, 14);
  o.a(1, 36) = kNan;
  o.a(2, 17) = kInf;
  for (std::size_t k = 0; k < p.k; ++k) {
    o.a(3, k) = 0.0f;
    o.a(4, k) = k % 2 == 0 ? 1e-38f : -1e-38f;
  }
  Matrix got(p.m, p.n), want(p.m, p.n);
  const GuardedFloats plain = PackTyped(*reference_, o.w), packed = PackTyped(*table_, o.w);
  GuardedFloats scratch = GuardedBytes(products().scratch(p.m, p.k)),
                plain_scratch = GuardedBytes(reference().scratch(p.m, p.k));
  products().gemm(ArgsOf(p, o, packed, &got, &scratch));
  reference().gemm(ArgsOf(p, o, plain, &want, &plain_scratch));
  for (std::size_t j = 0; j < p.n; ++j) {
    EXPECT_TRUE(std::isnan(got(1, j)));
    EXPECT_FALSE(std::isfinite(got(2, j)));
    EXPECT_EQ(got(3, j), 0.0f);
    EXPECT_NEAR(got(4, j), 0.0f, 1e-35f);
    EXPECT_NEAR(got(0, j), want(0, j), GemmTolerance(p.k, 1.0, 1.0));
    EXPECT_NEAR(got(5, j), want(5, j), GemmTolerance(p.k, 1.0, 1.0));
  }
}

TEST_P(TypedGemmTest, BitsDoNotDependOnTheDivision) {
  const Problem p{100, 203, 771, Activation::kGeluErf, true, true};
  const Operands o(type(), p, 11);
  const GuardedFloats packed = PackTyped(*table_, o.w);
  GuardedFloats scratch = GuardedBytes(products().scratch(p.m, p.k));
  Matrix whole(p.m, p.n);
  products().gemm(ArgsOf(p, o, packed, &whole, &scratch));
  const std::size_t block = table_->gemm_block_n;
  for (const std::size_t blocks_at_once : {1, 5}) {
    for (const std::size_t rows_at_once : {2, 13, 31}) {
      Matrix parts(p.m, p.n);
      for (std::size_t n = 0; n < p.n; n += blocks_at_once * block) {
        for (std::size_t m = 0; m < p.m;) {
          const std::size_t left = p.m - m;
          const std::size_t rows = left <= rows_at_once + 1 ? left : rows_at_once;
          GemmArgs args = ArgsOf(p, o, packed, &parts, &scratch);
          args.out += m * p.n;
          args.a += m * p.k;
          args.epilogue.residual += m * p.n;
          args.m = rows;
          args.n_begin = n;
          args.n_end = std::min(p.n, n + blocks_at_once * block);
          products().gemm(args);
          m += rows;
        }
      }
      ASSERT_EQ(std::memcmp(parts.data(), whole.data(), p.m * p.n * sizeof(float)), 0)
          << blocks_at_once << " blocks, " << rows_at_once << " rows at once";
    }
  }
}

TEST_P(TypedGemmTest, ColumnRangeLeavesTheRest) {
  for (const std::size_t m : {1, 5, 40}) {
    const Problem p{m, 4 * table_->gemm_block_n, 16};
    const Operands o(type(), p, 13);
    const GuardedFloats packed = PackTyped(*table_, o.w);
    GuardedFloats scratch = GuardedBytes(products().scratch(p.m, p.k));
    Matrix got(p.m, p.n);
    got.Fill(77.0f);
    GemmArgs args = ArgsOf(p, o, packed, &got, &scratch);
    args.n_begin = table_->gemm_block_n;
    args.n_end = 2 * table_->gemm_block_n;
    (m == 1 ? products().gemv : products().gemm)(args);
    for (std::size_t i = 0; i < p.m; ++i) {
      for (std::size_t j = 0; j < p.n; ++j) {
        const bool wanted = j >= args.n_begin && j < args.n_end;
        EXPECT_EQ(got(i, j) == 77.0f, !wanted) << i << ", " << j;
      }
    }
  }
}

TEST_P(TypedGemmTest, GatherAndUnknownIds) {
  const std::int32_t ids[] = {0, 4, 2, 2, -1, 5, INT32_MAX, INT32_MIN, 3};
  for (const std::size_t cols : AwkwardSizes()) {
    const TypedWeights words(type(), 5, cols, 1);
    Matrix got(9, cols, 3), want(9, cols);
    for (std::size_t i = 0; i < 9; ++i) {
      for (std::size_t j = 0; j < cols; ++j) {
        const bool known = ids[i] >= 0 && ids[i] < 5;
        want(i, j) = known ? 1.5f * words(static_cast<std::size_t>(ids[i]), j) : 0.0f;
      }
    }
    products().gather(got.data(), got.stride(), words.data(), words.scales(), ids, 9, cols, 5,
                      1.5f);
    ASSERT_TRUE(Same(got, want)) << cols << " columns";
  }
}

}  // namespace
}  // namespace gestus::test
