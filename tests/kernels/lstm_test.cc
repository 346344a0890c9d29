// One step of an LSTM, and many in a row; the hidden units divided between calls.
#include <cstring>

#include "tests/kernels/packed.h"

namespace gestus::test {
namespace {

using kernels::LstmStepArgs;

class LstmTest : public KernelTest {
 protected:
  static void Step(const kernels::KernelTable& table, const GuardedFloats& packed,
                   const Matrix& x_proj, const Matrix& h_in, std::size_t begin, std::size_t end,
                   Matrix* h_out, Matrix* c, bool backward = false) {
    LstmStepArgs args;
    args.h_out = h_out->data();
    args.c = c->data();
    args.x_proj = x_proj.data();
    args.packed = packed.data();
    args.h_in = h_in.data();
    args.hidden = h_in.cols();
    args.unit_begin = begin;
    args.unit_end = end;
    args.backward = backward;
    table.f32_lstm_step(args);
  }
};
GESTUS_TEST_ON_EVERY_ISA(LstmTest);

// Without weights and inputs all gates are 1/2: c = c/2, h = tanh(c/2) / 2.
TEST_P(LstmTest, KnownStep) {
  Matrix w(4, 1), x(1, 4), h(1, 1), h_out(1, 1), c(1, 1);
  w.Fill(0.0f);
  x.Fill(0.0f);
  h.Fill(1.0f);
  c.Fill(2.0f);
  const GuardedFloats packed = PackLstm(*table_, w);
  Step(*table_, packed, x, h, 0, 1, &h_out, &c);
  EXPECT_NEAR(c(0, 0), 1.0f, 2 * kEps);
  EXPECT_NEAR(h_out(0, 0), 0.5 * 0.76159415595576, 4 * kEps);
  // The order of the gates: only i and g open gives c = tanh(g).
  const float gates[] = {100.0f, -100.0f, 0.5f, 100.0f};
  std::memcpy(x.data(), gates, sizeof(gates));
  Step(*table_, packed, x, h, 0, 1, &h_out, &c);
  EXPECT_NEAR(c(0, 0), 0.46211715726, 4 * kEps);
  EXPECT_NEAR(h_out(0, 0), std::tanh(0.46211715726), 6 * kEps);
}

TEST_P(LstmTest, SizesAgainstReference) {
  std::vector<std::size_t> sizes = AwkwardSizes();
  sizes.push_back(100);
  sizes.push_back(768);
  std::uint32_t seed = 1;
  for (const std::size_t hidden : sizes) {
    SCOPED_TRACE(::testing::Message() << "hidden " << hidden);
    const Matrix w = Matrix::Random(4 * hidden, hidden, 0, ++seed, 0.5f);
    const Matrix x = Matrix::Random(1, 4 * hidden, 0, ++seed, 2.0f);
    const Matrix h = Matrix::Random(1, hidden, 0, ++seed);
    const Matrix c = Matrix::Random(1, hidden, 0, ++seed, 3.0f);
    Matrix want_h(1, hidden), want_c = c.Copy(0), got_h(1, hidden), got_c = c.Copy(0);
    want_h.set_seed(seed);
    Step(*reference_, PackLstm(*reference_, w), x, h, 0, hidden, &want_h, &want_c);
    Step(*table_, PackLstm(*table_, w), x, h, 0, hidden, &got_h, &got_c);
    const double allowed = LstmTolerance(hidden, 0.5, 1.0, 3.0);
    const auto tolerance = [=](std::size_t, std::size_t, double) { return allowed; };
    ASSERT_TRUE(Close(got_c, want_c, tolerance));
    ASSERT_TRUE(Close(got_h, want_h, tolerance));
  }
}

TEST_P(LstmTest, BitsDoNotDependOnDivisionAndDirection) {
  constexpr std::size_t kHidden = 100;
  const Matrix w = Matrix::Random(4 * kHidden, kHidden, 0, 1);
  const Matrix x = Matrix::Random(1, 4 * kHidden, 0, 2), h = Matrix::Random(1, kHidden, 0, 3);
  const Matrix c = Matrix::Random(1, kHidden, 0, 4);
  const GuardedFloats packed = PackLstm(*table_, w);
  Matrix whole_h(1, kHidden), whole_c = c.Copy(0);
  Step(*table_, packed, x, h, 0, kHidden, &whole_h, &whole_c);
  for (const std::size_t blocks : {1, 3, 100}) {
    Matrix parts_h(1, kHidden), parts_c = c.Copy(0);
    const std::size_t units = blocks * table_->lstm_block;
    for (std::size_t u = 0; u < kHidden; u += units) {
      Step(*table_, packed, x, h, u, std::min(kHidden, u + units), &parts_h, &parts_c,
           blocks != 1);
    }
    EXPECT_EQ(std::memcmp(parts_h.data(), whole_h.data(), kHidden * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(parts_c.data(), whole_c.data(), kHidden * sizeof(float)), 0);
  }
}

// The state forgets its errors: with contracting weights they stay those of a few steps.
TEST_P(LstmTest, HundredSteps) {
  constexpr std::size_t kHidden = 64;
  const Matrix w = Matrix::Random(4 * kHidden, kHidden, 0, 5, 0.05f);
  const GuardedFloats plain = PackLstm(*reference_, w), packed = PackLstm(*table_, w);
  Matrix h[2] = {Matrix(1, kHidden), Matrix(1, kHidden)}, c(1, kHidden);
  Matrix want_h[2] = {Matrix(1, kHidden), Matrix(1, kHidden)}, want_c(1, kHidden);
  for (Matrix* m : {&h[0], &c, &want_h[0], &want_c}) m->Fill(0.0f);
  for (std::uint32_t t = 0; t < 100; ++t) {
    const Matrix x = Matrix::Random(1, 4 * kHidden, 0, 100 + t);
    Step(*table_, packed, x, h[t % 2], 0, kHidden, &h[(t + 1) % 2], &c);
    Step(*reference_, plain, x, want_h[t % 2], 0, kHidden, &want_h[(t + 1) % 2], &want_c);
  }
  // sig(f) <= sig(2) = 0.88 keeps errors of 1 / (1 - 0.88) steps.
  const double allowed = 9.0 * LstmTolerance(kHidden, 0.05, 1.0, 3.0);
  const auto tolerance = [=](std::size_t, std::size_t, double) { return allowed; };
  EXPECT_TRUE(Close(h[0], want_h[0], tolerance));
  EXPECT_TRUE(Close(c, want_c, tolerance));
}

}  // namespace
}  // namespace gestus::test
