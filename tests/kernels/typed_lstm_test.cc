// One LSTM step with bf16 and 8-bit recurrent weights; the hidden units divided between calls.
#include "tests/kernels/typed_weights.h"

namespace gestus::test {
namespace {

using kernels::LstmStepArgs;
using kernels::ProductKernels;

struct State {
  Matrix h, c;
};

class TypedLstmTest : public TypedTest {
 protected:
  static GuardedFloats Pack(const ProductKernels& p, const TypedWeights& w) {
    GuardedFloats packed = GuardedBytes(p.lstm_packed_size(w.k));
    p.lstm_pack(packed.data(), w.data(), w.scales(), w.k);
    return packed;
  }
  static void Step(const ProductKernels& p, const GuardedFloats& packed, const Matrix& x,
                   const Matrix& h_in, std::size_t begin, std::size_t end, State* to,
                   bool backward = false) {
    GuardedFloats scratch = GuardedBytes(p.scratch(1, h_in.cols()));
    LstmStepArgs args;
    args.h_out = to->h.data();
    args.c = to->c.data();
    args.x_proj = x.data();
    args.packed = packed.data();
    args.h_in = h_in.data();
    args.hidden = h_in.cols();
    args.unit_begin = begin;
    args.unit_end = end;
    args.backward = backward;
    args.scratch = scratch.data();
    p.lstm_step(args);
  }
};
GESTUS_TEST_EVERY_TYPE_ON_EVERY_ISA(TypedLstmTest);

TEST_P(TypedLstmTest, SizesAgainstReference) {
  std::vector<std::size_t> sizes = AwkwardSizes();
  sizes.push_back(100);
  std::uint32_t seed = 1;
  for (const std::size_t hidden : sizes) {
    SCOPED_TRACE(::testing::Message() << "hidden " << hidden);
    const TypedWeights w(type(), 4 * hidden, hidden, ++seed, 0.5f);
    const Matrix x = Matrix::Random(1, 4 * hidden, 0, ++seed, 2.0f);
    const Matrix h = RoundToBf16(Matrix::Random(1, hidden, 0, ++seed));
    const Matrix c = Matrix::Random(1, hidden, 0, ++seed, 3.0f);
    State want{Matrix(1, hidden), c.Copy(0)}, got{Matrix(1, hidden), c.Copy(0)};
    want.h.set_seed(seed);
    Step(reference(), Pack(reference(), w), x, h, 0, hidden, &want);
    Step(products(), Pack(products(), w), x, h, 0, hidden, &got);
    // The sums of i8 are exact; what remains is that of one addition and of the functions.
    const double allowed = LstmTolerance(type() == Type::kI8 ? 1 : hidden, 0.5, 1.0, 3.0) +
                           (type() == Type::kI8 ? 8.0 * kEps * static_cast<double>(hidden) : 0.0);
    const auto tolerance = [=](std::size_t, std::size_t, double) { return allowed; };
    ASSERT_TRUE(Close(got.c, want.c, tolerance));
    ASSERT_TRUE(Close(got.h, want.h, tolerance));
  }
}

TEST_P(TypedLstmTest, BitsDoNotDependOnDivisionAndDirection) {
  constexpr std::size_t kHidden = 100;
  const TypedWeights w(type(), 4 * kHidden, kHidden, 1);
  const Matrix x = Matrix::Random(1, 4 * kHidden, 0, 2), h = Matrix::Random(1, kHidden, 0, 3);
  const Matrix c = Matrix::Random(1, kHidden, 0, 4);
  const GuardedFloats packed = Pack(products(), w);
  State whole{Matrix(1, kHidden), c.Copy(0)};
  Step(products(), packed, x, h, 0, kHidden, &whole);
  for (const std::size_t blocks : {1, 3, 100}) {
    State parts{Matrix(1, kHidden), c.Copy(0)};
    const std::size_t units = blocks * table_->lstm_block;
    for (std::size_t u = 0; u < kHidden; u += units)
      Step(products(), packed, x, h, u, std::min(kHidden, u + units), &parts,
           blocks != 1);
    EXPECT_EQ(std::memcmp(parts.h.data(), whole.h.data(), kHidden * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(parts.c.data(), whole.c.data(), kHidden * sizeof(float)), 0);
  }
}

}  // namespace
}  // namespace gestus::test
