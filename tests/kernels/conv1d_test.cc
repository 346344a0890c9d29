// A convolution as the engine composes it: pad by copying rows, then multiply overlapping rows.
#include "kernels/reference/reference.h"
#include "tests/kernels/packed.h"

namespace gestus::test {
namespace {

class Conv1dTest : public KernelTest {};
GESTUS_TEST_ON_EVERY_ISA(Conv1dTest);

TEST_P(Conv1dTest, CopyRowsAndGemmMakeAConvolution) {
  struct Shape {
    std::size_t length, in, out, kernel, step, pad;
  };
  const Shape shapes[] = {
      {64, 22, 64, 3, 1, 1}, {17, 1, 5, 5, 1, 2}, {30, 13, 33, 4, 2, 1}, {3, 8, 8, 3, 1, 0}};
  std::uint32_t seed = 1;
  for (const Shape& s : shapes) {
    SCOPED_TRACE(::testing::Message() << "length " << s.length << " in " << s.in);
    const std::size_t k = s.kernel * s.in, frames = (s.length + 2 * s.pad - s.kernel) / s.step + 1;
    const Matrix x = Matrix::Random(s.length, s.in, 0, ++seed);
    const Matrix w = Matrix::Random(s.out, k, 0, ++seed);
    const Matrix bias = Matrix::Random(1, s.out, 0, ++seed);
    Matrix want(frames, s.out), got(frames, s.out), padded(s.length + 2 * s.pad, s.in);
    want.set_seed(seed);
    kernels::reference::conv1d(want.data(), x.data(), w.data(), bias.data(), s.length, s.in, s.out,
                               s.kernel, s.step, s.pad);
    padded.Fill(0.0f);
    table_->f32_copy_rows(padded.data() + s.pad * s.in, padded.stride(), x.data(), x.stride(),
                          s.length, s.in);
    const GuardedFloats packed = PackGemm(*table_, w);
    kernels::GemmArgs args;
    args.out = got.data();
    args.out_stride = got.stride();
    args.a = padded.data();
    args.a_stride = static_cast<std::ptrdiff_t>(s.step * s.in);
    args.packed = packed.data();
    args.m = frames;
    args.n = args.n_end = s.out;
    args.k = k;
    args.epilogue.bias = bias.data();
    table_->f32_gemm(args);
    EXPECT_TRUE(Close(got, want, [&](std::size_t, std::size_t, double y) {
      return GemmTolerance(k, 1.0, 1.0) + kEps * (std::fabs(y) + 1.0);
    }));
  }
}

}  // namespace
}  // namespace gestus::test
