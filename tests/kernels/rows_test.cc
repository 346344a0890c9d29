// Kernels that move rows: all but the mean are exact.
#include "tests/kernels/kernel_test.h"

namespace gestus::test {
namespace {

class RowsTest : public KernelTest {};
GESTUS_TEST_ON_EVERY_ISA(RowsTest);

TEST_P(RowsTest, CopyRows) {
  for (const std::size_t cols : AwkwardSizes()) {
    const Matrix x = Matrix::Random(4, cols, 1, 1);
    for (const std::ptrdiff_t stride : {x.stride(), std::ptrdiff_t{0}}) {
      Matrix got(4, cols, 3), want(4, cols);
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < cols; ++j) want(i, j) = x(stride == 0 ? 0 : i, j);
      }
      table_->f32_copy_rows(got.data(), got.stride(), x.data(), stride, 4, cols);
      ASSERT_TRUE(Same(got, want)) << cols << " columns";
    }
  }
}

TEST_P(RowsTest, MeanRows) {
  const float x[] = {1.0f, 10.0f, 3.0f, -10.0f, 2.0f, 3.0f};
  float y[2];
  table_->f32_mean_rows(y, x, 2, 3, 2);
  EXPECT_EQ(y[0], 2.0f);
  EXPECT_EQ(y[1], 1.0f);
  for (const std::size_t cols : AwkwardSizes()) {
    for (const std::size_t rows : {1, 2, 61, 1214}) {
      const Matrix in = Matrix::Random(rows, cols, 2, static_cast<std::uint32_t>(rows));
      Matrix got(1, cols), want(1, cols);
      reference_->f32_mean_rows(want.data(), in.data(), in.stride(), rows, cols);
      table_->f32_mean_rows(got.data(), in.data(), in.stride(), rows, cols);
      // `rows` roundings of a sum that stays below rows, divided by rows; random as in a product.
      const double allowed = GemmTolerance(rows, 1.0, 1.0) / std::sqrt(static_cast<double>(rows));
      ASSERT_TRUE(Close(got, want, [=](std::size_t, std::size_t, double) { return allowed; }))
          << rows << " rows, " << cols << " columns";
    }
  }
}

TEST_P(RowsTest, GatherAndUnknownIds) {
  const std::int32_t ids[] = {0, 4, 2, 2, -1, 5, INT32_MAX, INT32_MIN, 3};
  for (const std::size_t cols : AwkwardSizes()) {
    const Matrix words = Matrix::Random(5, cols, 1, 1);
    Matrix got(9, cols, 3), want(9, cols);
    for (std::size_t i = 0; i < 9; ++i) {
      for (std::size_t j = 0; j < cols; ++j) {
        const bool known = ids[i] >= 0 && ids[i] < 5;
        want(i, j) = known ? 1.5f * words(static_cast<std::size_t>(ids[i]), j) : 0.0f;
      }
    }
    table_->f32_gather(got.data(), got.stride(), words.data(), words.stride(), ids, 9, cols, 5,
                       1.5f);
    ASSERT_TRUE(Same(got, want)) << cols << " columns";
  }
}

TEST_P(RowsTest, Patches) {
  struct Shape {
    std::size_t height, width, kh, kw, step_h, step_w;
    bool transposed;
  };
  // AST: 128 mel bands of 64 frames, patches 16 x 16 every 10; then odd ones.
  for (const Shape& s :
       {Shape{128, 64, 16, 16, 10, 10, true}, Shape{128, 64, 16, 16, 10, 10, false},
        Shape{7, 9, 3, 2, 2, 3, false}, Shape{5, 4, 5, 4, 1, 1, true}}) {
    const Matrix image = s.transposed ? Matrix::Random(s.width, s.height, 2, 1)
                                      : Matrix::Random(s.height, s.width, 2, 1);
    const std::size_t ph = (s.height - s.kh) / s.step_h + 1, pw = (s.width - s.kw) / s.step_w + 1;
    Matrix got(ph * pw, s.kh * s.kw, 3), want(ph * pw, s.kh * s.kw);
    for (std::size_t p = 0; p < ph * pw; ++p) {
      for (std::size_t e = 0; e < s.kh * s.kw; ++e) {
        const std::size_t h = p / pw * s.step_h + e / s.kw, w = p % pw * s.step_w + e % s.kw;
        want(p, e) = s.transposed ? image(w, h) : image(h, w);
      }
    }
    kernels::PatchArgs args;
    args.out = got.data();
    args.out_stride = got.stride();
    args.image = image.data();
    args.stride_h = s.transposed ? 1 : image.stride();
    args.stride_w = s.transposed ? image.stride() : 1;
    args.kh = s.kh;
    args.kw = s.kw;
    args.step_h = s.step_h;
    args.step_w = s.step_w;
    args.ph = ph;
    args.pw = pw;
    table_->f32_patches(args);
    EXPECT_TRUE(Same(got, want)) << s.height << " x " << s.width;
  }
}

}  // namespace
}  // namespace gestus::test
