// Layer normalisation: sizes, rows of one value, large offsets, sizes that overflow float.
#include "tests/kernels/kernel_test.h"

namespace gestus::test {
namespace {

constexpr float kVarianceFloor = 1e-5f;

class LayerNormTest : public KernelTest {
 protected:
  void Normalise(const kernels::KernelTable& table, const Matrix& x, Matrix* y) {
    table.f32_layer_norm(y->data(), y->stride(), x.data(), x.stride(), gamma_.data(), beta_.data(),
                         kVarianceFloor, x.rows(), x.cols());
  }
  void Check(const Matrix& x) {
    SCOPED_TRACE(::testing::Message() << x.cols() << " columns");
    gamma_ = Matrix::Random(1, x.cols(), 0, 77);
    beta_ = Matrix::Random(1, x.cols(), 0, 78);
    Matrix got(x.rows(), x.cols(), 3), want(x.rows(), x.cols());
    want.set_seed(x.seed());
    Normalise(*reference_, x, &want);
    Normalise(*table_, x, &got);
    ASSERT_TRUE(Close(got, want, [&](std::size_t i, std::size_t j, double y) {
      return ToleranceAt(x, i, j, y);
    }));
  }

 private:
  double ToleranceAt(const Matrix& x, std::size_t i, std::size_t j, double y) const {
    double mean = 0.0, variance = 0.0, max = 0.0;
    const double count = static_cast<double>(x.cols());
    for (std::size_t c = 0; c < x.cols(); ++c) {
      mean += x(i, c) / count;
      max = std::fmax(max, std::fabs(x(i, c)));
    }
    for (std::size_t c = 0; c < x.cols(); ++c) variance += std::pow(x(i, c) - mean, 2.0) / count;
    const double sigma = std::sqrt(variance + kVarianceFloor);
    return LayerNormTolerance(x.cols(), max, sigma, (x(i, j) - mean) / sigma, gamma_(0, j), y);
  }
  Matrix gamma_{1, 1}, beta_{1, 1};
};
GESTUS_TEST_ON_EVERY_ISA(LayerNormTest);

TEST_P(LayerNormTest, KnownValues) {
  const float x[] = {1.0f, 3.0f}, gamma[] = {2.0f, 10.0f}, beta[] = {0.5f, -1.0f};
  float y[2];
  table_->f32_layer_norm(y, 2, x, 2, gamma, beta, 0.0f, 1, 2);
  EXPECT_EQ(y[0], -1.5f);
  EXPECT_EQ(y[1], 9.0f);
  // Variance 1 and eps 3: half the size.
  table_->f32_layer_norm(y, 2, x, 2, gamma, beta, 3.0f, 1, 2);
  EXPECT_EQ(y[0], -0.5f);
  EXPECT_EQ(y[1], 4.0f);
}

TEST_P(LayerNormTest, AwkwardSizes) {
  for (const std::size_t cols : AwkwardSizes()) {
    Check(Matrix::Random(3, cols, 2, static_cast<std::uint32_t>(cols)));
  }
  Check(Matrix::Random(62, 768, 0, 1, 4.0f));
  Check(Matrix::Random(64, 384, 0, 2, 0.01f));
}

TEST_P(LayerNormTest, LargeOffset) {
  Matrix x = Matrix::Random(4, 300, 0, 3);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 300; ++j) x(i, j) += 1000.0f;
  }
  Check(x);
}

// What a rounded mean leaves over must not be taken for a signal.
TEST_P(LayerNormTest, RowsOfOneValueGiveBeta) {
  const float gamma[67] = {1.0f, 1.0f, 1.0f};
  float beta[67];
  for (std::size_t j = 0; j < 67; ++j) beta[j] = static_cast<float>(j);
  for (const float value : {0.0f, 1.0f, 0.1f, -1234.567f, 3.3e7f, 1e20f}) {
    Matrix x(1, 67), y(1, 67);
    x.Fill(value);
    table_->f32_layer_norm(y.data(), y.stride(), x.data(), x.stride(), gamma, beta, kVarianceFloor,
                           1, 67);
    for (std::size_t j = 0; j < 67; ++j) EXPECT_EQ(y(0, j), beta[j]) << value;
  }
}

TEST_P(LayerNormTest, SquaresThatOverflowFloat) {
  Check(Matrix::Random(3, 50, 0, 4, 1e20f));
  Check(Matrix::Random(3, 50, 0, 5, 3e38f));
  Check(Matrix::Random(3, 50, 0, 6, 1e-30f));
}

TEST_P(LayerNormTest, NanStaysInItsRow) {
  Matrix x = Matrix::Random(3, 20, 0, 7), y(3, 20);
  x(1, 4) = std::nanf("");
  const Matrix ones = [] {
    Matrix m(1, 20);
    m.Fill(1.0f);
    return m;
  }();
  table_->f32_layer_norm(y.data(), y.stride(), x.data(), x.stride(), ones.data(), ones.data(),
                         kVarianceFloor, 3, 20);
  for (std::size_t j = 0; j < 20; ++j) {
    EXPECT_TRUE(std::isfinite(y(0, j)) && std::isnan(y(1, j)) && std::isfinite(y(2, j)));
  }
}

TEST_P(LayerNormTest, InPlace) {
  const Matrix x = Matrix::Random(4, 45, 1, 9), gamma = Matrix::Random(1, 45, 0, 10);
  Matrix y = x.Copy(1), want(4, 45);
  table_->f32_layer_norm(want.data(), want.stride(), x.data(), x.stride(), gamma.data(),
                         gamma.data(), kVarianceFloor, 4, 45);
  table_->f32_layer_norm(y.data(), y.stride(), y.data(), y.stride(), gamma.data(), gamma.data(),
                         kVarianceFloor, 4, 45);
  EXPECT_TRUE(Same(y, want));
}

}  // namespace
}  // namespace gestus::test
