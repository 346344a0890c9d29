// Attention: self and cross, causal with an offset, masked keys, odd and unequal head sizes.
#include "tests/kernels/kernel_test.h"

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

void Attend(const kernels::KernelTable& table, const Problem& p, const Matrix& q, const Matrix& k,
            const Matrix& v, const Matrix& bias, Matrix* out) {
  GuardedFloats scratch(table.f32_attention_scratch(p.rows, p.keys, p.head_dim, p.value_dim), 64);
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
  table.f32_attention(args);
}

void Check(const kernels::KernelTable& table, const kernels::KernelTable& reference,
           const Problem& p, std::uint32_t seed) {
  SCOPED_TRACE(::testing::Message()
               << "rows " << p.rows << " keys " << p.keys << " head " << p.head_dim << " value "
               << p.value_dim << " causal " << p.causal << " mask " << p.mask);
  const Matrix q = Matrix::Random(p.rows, p.head_dim, p.gap, seed, p.size);
  const Matrix k = Matrix::Random(p.keys, p.head_dim, p.gap, seed + 1, p.size);
  const Matrix v = Matrix::Random(p.keys, p.value_dim, p.gap, seed + 2, p.size);
  Matrix bias(1, p.keys);
  for (std::size_t j = 0; j < p.keys; ++j) {
    bias(0, j) = p.mask == Problem::kAllKeys || j % 3 != 1 ? -kInf : 0.0f;
  }
  Matrix want(p.rows, p.value_dim), got(p.rows, p.value_dim, p.gap);
  want.set_seed(seed);
  Attend(reference, p, q, k, v, bias, &want);
  Attend(table, p, q, k, v, bias, &got);
  const double allowed = AttentionTolerance({p.keys, p.head_dim, p.scale, p.size, p.size, p.size});
  ASSERT_TRUE(Close(got, want, [=](std::size_t, std::size_t, double) { return allowed; }));
}

class AttentionTest : public KernelTest {};
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
  Attend(*table_, {1, 2, 1, 2, 0.5f}, q, k, v, bias, &got);
  EXPECT_NEAR(got(0, 0), 7.0f, 7 * 8 * kEps);
  EXPECT_NEAR(got(0, 1), -3.0f, 3 * 8 * kEps);
}

TEST_P(AttentionTest, RealShapes) {
  const Problem shapes[] = {{62, 62, 64, 64}, {64, 64, 384, 384, 0.051f}, {64, 64, 22, 22, 0.2132f},
                            {1, 64, 64, 64},  {64, 62, 96, 64, 0.1f},     {128, 130, 64, 64}};
  std::uint32_t seed = 1;
  for (const Problem& p : shapes) Check(*table_, *reference_, p, seed += 10);
}

TEST_P(AttentionTest, AwkwardSizes) {
  std::uint32_t seed = 1000;
  for (const std::size_t n : AwkwardSizes()) {
    Check(*table_, *reference_, {5, n, 8, 8, 0.3f}, seed += 10);
    Check(*table_, *reference_, {3, 11, n, 7, 0.1f}, seed += 10);
    Check(*table_, *reference_, {3, 11, 7, n, 0.3f}, seed += 10);
    if (n < 130) Check(*table_, *reference_, {n, 19, 12, 9, 0.3f}, seed += 10);
  }
}

TEST_P(AttentionTest, CausalWithMasksAndStrides) {
  std::uint32_t seed = 5000;
  for (const auto mask : {Problem::kNoMask, Problem::kSomeKeys, Problem::kAllKeys}) {
    for (const std::size_t first : {0, 1, 30, 63}) {
      Problem p{17, 64, 22, 33, 0.2f, true, first, mask, 3};
      Check(*table_, *reference_, p, seed += 10);
      p.rows = 1;
      Check(*table_, *reference_, p, seed += 10);
    }
    Check(*table_, *reference_, {64, 64, 64, 64, 0.125f, true, 0, mask}, seed += 10);
    Check(*table_, *reference_, {31, 77, 64, 64, 0.125f, false, 0, mask, 1}, seed += 10);
  }
}

TEST_P(AttentionTest, MaskedQueriesGiveZeros) {
  const Problem p{4, 20, 16, 16, 0.25f, false, 0, Problem::kAllKeys};
  const Matrix q = Matrix::Random(4, 16, 0, 1), k = Matrix::Random(20, 16, 0, 2);
  Matrix bias(1, 20), got(4, 16), zeros(4, 16);
  bias.Fill(-kInf);
  zeros.Fill(0.0f);
  Attend(*table_, p, q, k, Matrix::Random(20, 16, 0, 3), bias, &got);
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
  Attend(*table_, p, q, k, v, bias, &got);
  EXPECT_TRUE(Close(got, want, [](std::size_t, std::size_t, double) { return 2.0 * kEps; }));
}

}  // namespace
}  // namespace gestus::test
