// Attention: self and cross, causal with an offset, masked keys, odd and unequal head sizes; in
// float32, and in bf16 where a machine has that.
#include "tests/kernels/kernel_test.h"
#include "tests/kernels/typed_weights.h"

namespace gestus::test {
namespace {

using kernels::AttentionArgs;

constexpr float kInf = std::numeric_limits<float>::infinity();

struct Problem {
  std::size_t rows, keys, head_dim, value_dim;
  float scale = 0.125f;
  bool causal = false;
  std::size_t first_row = 0;
  enum Mask { kNoMask, kSomeKeys, kAllKeys } mask = kNoMask;
  std::size_t gap = 0;
  float size = 1.0f;  // of the elements of q, k and v
};

struct Kernel {
  std::size_t (*scratch)(std::size_t rows, std::size_t keys, std::size_t head_dim,
                         std::size_t value_dim);
  void (*attend)(const AttentionArgs& args);
  double weight_error = 0.0;  // of rounding the weights of values

  static Kernel F32(const kernels::KernelTable& table) {
    return {table.f32_attention_scratch, table.f32_attention};
  }
  static Kernel Bf16(const kernels::KernelTable& table) {
    return {table.bf16->attention_scratch, table.bf16->attention, 1.0 / 256};
  }
};

void Attend(const Kernel& kernel, const Problem& p, const Matrix& q, const Matrix& k,
            const Matrix& v, const Matrix& bias, Matrix* out) {
  GuardedFloats scratch(kernel.scratch(p.rows, p.keys, p.head_dim, p.value_dim), 64);
  AttentionArgs args;
  args.out = out->data();
  args.out_stride = out->stride();
  args.q = q.data();
  args.q_stride = q.stride();
  args.k = k.data();
  args.k_stride = k.stride();
  args.v = v.data();
  args.v_stride = v.stride();
  args.key_bias = p.mask == Problem::kNoMask ? nullptr : bias.data();
  args.rows = p.rows;
  args.keys = p.keys;
  args.head_dim = p.head_dim;
  args.value_dim = p.value_dim;
  args.scale = p.scale;
  args.causal = p.causal;
  args.first_row = p.first_row;
  args.scratch = scratch.data();
  kernel.attend(args);
}

// Elements are numbers of the kernel's type, so that it has nothing to round but its weights.
void Check(const Kernel& kernel, const kernels::KernelTable& reference, const Problem& p,
           std::uint32_t seed) {
  SCOPED_TRACE(::testing::Message()
               << "rows " << p.rows << " keys " << p.keys << " head " << p.head_dim << " value "
               << p.value_dim << " causal " << p.causal << " mask " << p.mask);
  const auto random = [&](std::size_t rows, std::size_t cols, std::uint32_t n) {
    Matrix m = Matrix::Random(rows, cols, p.gap, seed + n, p.size);
    return kernel.weight_error > 0 ? RoundToBf16(std::move(m)) : std::move(m);
  };
  const Matrix q = random(p.rows, p.head_dim, 0), k = random(p.keys, p.head_dim, 1),
               v = random(p.keys, p.value_dim, 2);
  Matrix bias(1, p.keys);
  for (std::size_t j = 0; j < p.keys; ++j) {
    bias(0, j) = p.mask == Problem::kAllKeys || j % 3 != 1 ? -kInf : 0.0f;
  }
  Matrix want(p.rows, p.value_dim), got(p.rows, p.value_dim, p.gap);
  want.set_seed(seed);
  Attend(Kernel::F32(reference), p, q, k, v, bias, &want);
  Attend(kernel, p, q, k, v, bias, &got);
  const double allowed = AttentionTolerance({p.keys, p.head_dim, p.scale, p.size, p.size, p.size}) +
                         kernel.weight_error * p.size;
  ASSERT_TRUE(Close(got, want, [=](std::size_t, std::size_t, double) { return allowed; }));
}

// The bits of a row must not depend on which rows it is computed with.
void CheckRowsAlone(const Kernel& kernel, Problem p, std::uint32_t seed) {
  const Matrix q = Matrix::Random(p.rows, p.head_dim, p.gap, seed),
               k = Matrix::Random(p.keys, p.head_dim, p.gap, seed + 1),
               v = Matrix::Random(p.keys, p.value_dim, p.gap, seed + 2);
  Matrix bias(1, p.keys), together(p.rows, p.value_dim);
  for (std::size_t j = 0; j < p.keys; ++j) bias(0, j) = j % 5 == 2 ? -kInf : 0.0f;
  Attend(kernel, p, q, k, v, bias, &together);
  const std::size_t rows = p.rows, first = p.first_row;
  p.rows = 1;
  for (std::size_t i = 0; i < rows; ++i) {
    Matrix row(1, p.head_dim), alone(1, p.value_dim), want(1, p.value_dim);
    for (std::size_t c = 0; c < p.head_dim; ++c) row(0, c) = q(i, c);
    for (std::size_t c = 0; c < p.value_dim; ++c) want(0, c) = together(i, c);
    p.first_row = first + i;
    Attend(kernel, p, row, k, v, bias, &alone);
    ASSERT_TRUE(Same(alone, want)) << "row " << i;
  }
}

class AttentionTest : public KernelTest {
 protected:
  /// f(kernel) for each kernel of the table.
  template <class F>
  void ForEachType(const F& f) {
    f(Kernel::F32(*table_));
    if (table_->bf16 != nullptr && table_->bf16->attention != nullptr) f(Kernel::Bf16(*table_));
  }
  void CheckAll(const Problem& p, std::uint32_t seed) {
    ForEachType([&](const Kernel& kernel) { Check(kernel, *reference_, p, seed); });
  }
};
GESTUS_TEST_ON_EVERY_ISA(AttentionTest);

// Two keys with scores 0 and ln 3: weights 1/4 and 3/4.
TEST_P(AttentionTest, KnownWeights) {
  Matrix q(1, 1), k(2, 1), v(2, 2), bias(1, 2), got(1, 2);
  q(0, 0) = 1.0f;
  k(0, 0) = 0.0f;
  k(1, 0) = 2.0f * 1.09861229f;
  v(0, 0) = 4.0f;
  v(0, 1) = 0.0f;
  v(1, 0) = 8.0f;
  v(1, 1) = -4.0f;
  Attend(Kernel::F32(*table_), {1, 2, 1, 2, 0.5f}, q, k, v, bias, &got);
  EXPECT_NEAR(got(0, 0), 7.0f, 7 * 8 * kEps);
  EXPECT_NEAR(got(0, 1), -3.0f, 3 * 8 * kEps);
}

TEST_P(AttentionTest, RealShapes) {
  const Problem shapes[] = {{62, 62, 64, 64}, {64, 64, 384, 384, 0.051f}, {64, 64, 22, 22, 0.2132f},
                            {1, 64, 64, 64},  {64, 62, 96, 64, 0.1f},     {128, 130, 64, 64}};
  std::uint32_t seed = 1;
  for (const Problem& p : shapes) CheckAll(p, seed += 10);
}

TEST_P(AttentionTest, AwkwardSizes) {
  std::uint32_t seed = 1000;
  for (const std::size_t n : AwkwardSizes()) {
    CheckAll({5, n, 8, 8, 0.3f}, seed += 10);
    CheckAll({3, 11, n, 7, 0.1f}, seed += 10);
    CheckAll({3, 11, 7, n, 0.3f}, seed += 10);
    if (n < 130) CheckAll({n, 19, 12, 9, 0.3f}, seed += 10);
  }
}

TEST_P(AttentionTest, CausalWithMasksAndStrides) {
  std::uint32_t seed = 5000;
  for (const auto mask : {Problem::kNoMask, Problem::kSomeKeys, Problem::kAllKeys}) {
    for (const std::size_t first : {0, 1, 30, 63}) {
      Problem p{17, 64, 22, 33, 0.2f, true, first, mask, 3};
      CheckAll(p, seed += 10);
      p.rows = 1;
      CheckAll(p, seed += 10);
    }
    CheckAll({64, 64, 64, 64, 0.125f, true, 0, mask}, seed += 10);
    CheckAll({31, 77, 64, 64, 0.125f, false, 0, mask, 1}, seed += 10);
  }
}

TEST_P(AttentionTest, MoreKeysThanOnePanel) {
  std::uint32_t seed = 9000;
  for (const std::size_t keys : {65, 96, 127, 300, 1214}) {
    CheckAll({30, keys, 64, 64}, seed += 10);
    CheckAll({9, keys, 21, 35, 0.2f, true, keys - 9}, seed += 10);
  }
}

TEST_P(AttentionTest, RowsAreTheSameAlone) {
  ForEachType([&](const Kernel& kernel) {
    CheckRowsAlone(kernel, {29, 77, 64, 64}, 1);
    CheckRowsAlone(kernel, {40, 40, 16, 24, 0.25f, true}, 2);
    CheckRowsAlone(kernel, {17, 130, 22, 33, 0.2f, true, 110, Problem::kSomeKeys, 3}, 3);
  });
}

TEST_P(AttentionTest, NoKeysGiveZeros) {
  const Problem p{3, 0, 8, 20, 0.3f};
  const Matrix q = Matrix::Random(3, 8, 0, 1), none(0, 8), nothing(0, 20), bias(1, 1);
  ForEachType([&](const Kernel& kernel) {
    Matrix got(3, 20), zeros(3, 20);
    zeros.Fill(0.0f);
    Attend(kernel, p, q, none, nothing, bias, &got);
    EXPECT_TRUE(Same(got, zeros));
  });
}

TEST_P(AttentionTest, MaskedQueriesGiveZeros) {
  const Problem p{4, 20, 16, 16, 0.25f, false, 0, Problem::kAllKeys};
  const Matrix q = Matrix::Random(4, 16, 0, 1), k = Matrix::Random(20, 16, 0, 2);
  Matrix bias(1, 20), got(4, 16), zeros(4, 16);
  bias.Fill(-kInf);
  zeros.Fill(0.0f);
  Attend(Kernel::F32(*table_), p, q, k, Matrix::Random(20, 16, 0, 3), bias, &got);
  EXPECT_TRUE(Same(got, zeros));
}

// Scores of +-40,000 would overflow every exponential that is not taken against the maximum.
TEST_P(AttentionTest, HugeScoresSelectOneKey) {
  const Problem p{3, 40, 4, 5, 1.0f};
  Matrix q(3, 4), k(40, 4), bias(1, 40), got(3, 5), want(3, 5);
  q.Fill(100.0f);
  k.Fill(-100.0f);
  for (std::size_t c = 0; c < 4; ++c) k(23, c) = 100.0f;
  const Matrix v = Matrix::Random(40, 5, 0, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 5; ++c) want(i, c) = v(23, c);
  }
  Attend(Kernel::F32(*table_), p, q, k, v, bias, &got);
  EXPECT_TRUE(Close(got, want, [](std::size_t, std::size_t, double) { return 2.0 * kEps; }));
}

}  // namespace
}  // namespace gestus::test
