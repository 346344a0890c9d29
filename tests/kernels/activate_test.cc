// The elementary functions behind f32_activate: dense sweeps, tails, signed zeros, denormals,
// infinities and NaN, against double precision at the table of tests/tolerance.h.
#include "kernels/reference/reference.h"
#include "tests/kernels/kernel_test.h"

namespace gestus::test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kAlpha = 0.2f;

class ActivateTest : public KernelTest {
 protected:
  void Check(Activation act, const Matrix& x) {
    SCOPED_TRACE(::testing::Message() << "activation " << static_cast<int>(act));
    Matrix got(x.rows(), x.cols(), 3), want(x.rows(), x.cols());
    want.set_seed(x.seed());
    reference_->f32_activate(want.data(), want.stride(), x.data(), x.stride(), x.rows(), x.cols(),
                             act, kAlpha);
    table_->f32_activate(got.data(), got.stride(), x.data(), x.stride(), x.rows(), x.cols(), act,
                         kAlpha);
    EXPECT_TRUE(Close(got, want, [&](std::size_t i, std::size_t j, double y) {
      return ActivationTolerance(act, x(i, j), y);
    })) << "the argument stands at the same index";
  }
  void CheckAll(const Matrix& x) {
    for (int act = 0; act <= static_cast<int>(Activation::kSigmoid); ++act) {
      Check(static_cast<Activation>(act), x);
    }
  }
};
GESTUS_TEST_ON_EVERY_ISA(ActivateTest);

TEST_P(ActivateTest, KnownValues) {
  const float x[] = {1.0f, -1.0f};
  const struct {
    Activation act;
    double plus, minus;
  } known[] = {{Activation::kRelu, 1.0, 0.0},
               {Activation::kLeakyRelu, 1.0, -0.2},
               {Activation::kGeluErf, 0.84134474607, -0.15865525393},
               {Activation::kGeluTanh, 0.84119199061, -0.15880800939},
               {Activation::kTanh, 0.76159415596, -0.76159415596},
               {Activation::kSigmoid, 0.73105857863, 0.26894142137}};
  for (const auto& k : known) {
    float y[2];
    table_->f32_activate(y, 2, x, 2, 1, 2, k.act, kAlpha);
    EXPECT_NEAR(y[0], k.plus, 3 * kEps) << static_cast<int>(k.act);
    EXPECT_NEAR(y[1], k.minus, 3 * kEps) << static_cast<int>(k.act);
  }
}

TEST_P(ActivateTest, DenseSweep) {
  constexpr std::size_t kCount = 200003;
  Matrix x(1, kCount);
  for (std::size_t i = 0; i < kCount; ++i) x(0, i) = -100.0f + 0.001f * static_cast<float>(i);
  CheckAll(x);
}

// Every exponent: from the denormals to the largest float, both signs.
TEST_P(ActivateTest, EveryMagnitude) {
  Matrix x(2, 8 * 256);
  for (std::uint32_t i = 0; i < 8 * 255; ++i) {
    x(0, i) = std::bit_cast<float>(i << 20 | 0x5a5a5u);
    x(1, i) = -x(0, i);
  }
  for (std::uint32_t i = 8 * 255; i < 8 * 256; ++i) x(0, i) = x(1, i) = 0.0f;
  CheckAll(x);
}

TEST_P(ActivateTest, SpecialValues) {
  const float values[] = {0.0f,   -0.0f,   kInf,    -kInf,  std::nanf(""), 1e-40f, -1e-40f,
                          1e-45f, -1e-45f, 1e4f,    -1e4f,  3e38f,         -3e38f, 88.7228f,
                          -87.4f, -87.3f,  -103.9f, 9.009f, 9.011f,        5.54f,  -5.55f};
  // Each at every place of a vector and in the tail.
  for (const float value : values) {
    Matrix x(1, 37);
    x.Fill(value);
    CheckAll(x);
  }
}

TEST_P(ActivateTest, SaturatesExactly) {
  const float x[] = {1e4f, -1e4f, kInf, -kInf};
  float y[4];
  table_->f32_activate(y, 4, x, 4, 1, 4, Activation::kTanh, 0.0f);
  EXPECT_EQ(y[0], 1.0f);
  EXPECT_EQ(y[1], -1.0f);
  table_->f32_activate(y, 4, x, 4, 1, 4, Activation::kGeluErf, 0.0f);
  EXPECT_EQ(y[0], 1e4f);
  EXPECT_EQ(y[1], 0.0f);
  EXPECT_EQ(y[3], 0.0f);
  table_->f32_activate(y, 4, x, 4, 1, 4, Activation::kGeluTanh, 0.0f);
  EXPECT_EQ(y[1], 0.0f);
  EXPECT_EQ(y[3], 0.0f);
  table_->f32_activate(y, 4, x, 4, 1, 4, Activation::kSigmoid, 0.0f);
  EXPECT_EQ(y[0], 1.0f);
  EXPECT_EQ(y[3], 0.0f);
}

TEST_P(ActivateTest, KeepsTheSignOfZero) {
  const float x[] = {0.0f, -0.0f};
  float y[2];
  table_->f32_activate(y, 2, x, 2, 1, 2, Activation::kTanh, 0.0f);
  EXPECT_FALSE(std::signbit(y[0]));
  EXPECT_TRUE(std::signbit(y[1]));
}

TEST_P(ActivateTest, AwkwardSizesAndInPlace) {
  for (const std::size_t cols : AwkwardSizes()) {
    CheckAll(Matrix::Random(3, cols, 2, static_cast<std::uint32_t>(cols), 4.0f));
  }
  const Matrix x = Matrix::Random(4, 45, 1, 9);
  Matrix y = x.Copy(1), want(4, 45);
  table_->f32_activate(want.data(), want.stride(), x.data(), x.stride(), 4, 45, Activation::kTanh,
                       0.0f);
  table_->f32_activate(y.data(), y.stride(), y.data(), y.stride(), 4, 45, Activation::kTanh, 0.0f);
  EXPECT_TRUE(Same(y, want));
}

}  // namespace
}  // namespace gestus::test
