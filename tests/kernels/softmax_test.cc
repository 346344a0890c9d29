// Softmax: sizes, ranges that overflow without the maximum, masked rows, NaN.
#include "tests/kernels/kernel_test.h"

namespace gestus::test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

class SoftmaxTest : public KernelTest {
 protected:
  void Check(const Matrix& x, double range) {
    SCOPED_TRACE(::testing::Message() << x.cols() << " columns");
    Matrix got(x.rows(), x.cols(), 3), want(x.rows(), x.cols());
    want.set_seed(x.seed());
    reference_->f32_softmax(want.data(), want.stride(), x.data(), x.stride(), x.rows(), x.cols());
    table_->f32_softmax(got.data(), got.stride(), x.data(), x.stride(), x.rows(), x.cols());
    ASSERT_TRUE(Close(got, want, [&](std::size_t, std::size_t, double y) {
      return SoftmaxTolerance(x.cols(), range, y);
    }));
  }
};
GESTUS_TEST_ON_EVERY_ISA(SoftmaxTest);

TEST_P(SoftmaxTest, KnownValues) {
  const float x[] = {0.0f, 0.69314718f, 1.60943791f};
  float y[3];
  table_->f32_softmax(y, 3, x, 3, 1, 3);
  EXPECT_NEAR(y[0], 0.125, 2 * kEps);
  EXPECT_NEAR(y[1], 0.25, 2 * kEps);
  EXPECT_NEAR(y[2], 0.625, 2 * kEps);
}

TEST_P(SoftmaxTest, AwkwardSizes) {
  for (const std::size_t cols : AwkwardSizes()) {
    Check(Matrix::Random(3, cols, 2, static_cast<std::uint32_t>(cols), 5.0f), 10.0);
  }
  Check(Matrix::Random(62, 62, 0, 1), 2.0);
  Check(Matrix::Random(5, 1214, 0, 2, 30.0f), 60.0);
}

TEST_P(SoftmaxTest, HugeEqualAndMaskedRows) {
  Matrix x = Matrix::Random(6, 21, 1, 3, 1e4f);
  for (std::size_t j = 0; j < 21; ++j) {
    x(1, j) = 1e4f;
    x(2, j) = -1e4f;
    x(3, j) = -kInf;
    x(4, j) = j == 20 ? 5.0f : -kInf;
    x(5, j) = j == 3 ? -kInf : 0.0f;
  }
  Check(x, 2e4);
  Matrix y(6, 21);
  table_->f32_softmax(y.data(), y.stride(), x.data(), x.stride(), 6, 21);
  for (std::size_t j = 0; j < 21; ++j) EXPECT_EQ(y(3, j), 0.0f);
  EXPECT_EQ(y(4, 20), 1.0f);
}

TEST_P(SoftmaxTest, NanIsNotHidden) {
  for (const std::size_t where : {0, 7, 20}) {
    Matrix x = Matrix::Random(1, 21, 0, 4), y(1, 21);
    x(0, where) = std::nanf("");
    table_->f32_softmax(y.data(), y.stride(), x.data(), x.stride(), 1, 21);
    EXPECT_TRUE(std::isnan(y(0, where))) << where;
  }
}

TEST_P(SoftmaxTest, InPlace) {
  const Matrix x = Matrix::Random(4, 45, 1, 9);
  Matrix y = x.Copy(1), want(4, 45);
  table_->f32_softmax(want.data(), want.stride(), x.data(), x.stride(), 4, 45);
  table_->f32_softmax(y.data(), y.stride(), y.data(), y.stride(), 4, 45);
  EXPECT_TRUE(Same(y, want));
}

}  // namespace
}  // namespace gestus::test
