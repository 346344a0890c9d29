// Sum and affine map.
#include "tests/kernels/kernel_test.h"

namespace gestus::test {
namespace {

class ElementwiseTest : public KernelTest {};
GESTUS_TEST_ON_EVERY_ISA(ElementwiseTest);

TEST_P(ElementwiseTest, AddIsExactlyOneRounding) {
  for (const std::size_t cols : AwkwardSizes()) {
    const Matrix a = Matrix::Random(3, cols, 1, 1), b = Matrix::Random(3, cols, 2, 2);
    for (const std::ptrdiff_t b_stride : {b.stride(), std::ptrdiff_t{0}}) {
      Matrix got(3, cols, 3), want(3, cols);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < cols; ++j) want(i, j) = a(i, j) + b(b_stride == 0 ? 0 : i, j);
      }
      table_->f32_add(got.data(), got.stride(), a.data(), a.stride(), b.data(), b_stride, 3, cols);
      ASSERT_TRUE(Same(got, want)) << cols << " columns";
      Matrix in_place = a.Copy(4);
      table_->f32_add(in_place.data(), in_place.stride(), in_place.data(), in_place.stride(),
                      b.data(), b_stride, 3, cols);
      ASSERT_TRUE(Same(in_place, want)) << cols << " columns, in place";
    }
  }
}

TEST_P(ElementwiseTest, AddSpecialValues) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const float a[] = {kInf, kInf, 1e-40f, -0.0f, 3e38f}, b[] = {-kInf, 1.0f, 1e-40f, -0.0f, 3e38f};
  float y[5];
  table_->f32_add(y, 5, a, 5, b, 5, 1, 5);
  EXPECT_TRUE(std::isnan(y[0]));
  EXPECT_EQ(y[1], kInf);
  EXPECT_EQ(y[2], a[2] + b[2]);
  EXPECT_TRUE(y[3] == 0.0f && std::signbit(y[3]));
  EXPECT_EQ(y[4], kInf);
}

TEST_P(ElementwiseTest, Affine) {
  for (const std::size_t cols : AwkwardSizes()) {
    const Matrix x = Matrix::Random(3, cols, 1, 1), scale = Matrix::Random(1, cols, 0, 2, 3.0f),
                 shift = Matrix::Random(1, cols, 0, 3);
    Matrix got(3, cols, 3), want(3, cols);
    reference_->f32_affine(want.data(), want.stride(), x.data(), x.stride(), scale.data(),
                           shift.data(), 3, cols);
    table_->f32_affine(got.data(), got.stride(), x.data(), x.stride(), scale.data(), shift.data(),
                       3, cols);
    // One rounding of the sum, one of the reference's result and, without a fused multiply-add, one
    // of the product.
    ASSERT_TRUE(Close(got, want,
                      [&](std::size_t i, std::size_t j, double y) {
                        return kEps * (std::fabs(y) + std::fabs(x(i, j) * scale(0, j)) / 2.0);
                      }))
        << cols << " columns";
  }
  const float x[] = {2.0f, 3.0f}, scale[] = {10.0f, -1.0f}, shift[] = {1.0f, 0.5f};
  float y[2];
  table_->f32_affine(y, 2, x, 2, scale, shift, 1, 2);
  EXPECT_EQ(y[0], 21.0f);
  EXPECT_EQ(y[1], -2.5f);
}

}  // namespace
}  // namespace gestus::test
