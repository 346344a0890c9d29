// Random bf16 and 8-bit weights for kernel tests, and what they are as numbers.
#ifndef GESTUS_TESTS_KERNELS_TYPED_WEIGHTS_H_
#define GESTUS_TESTS_KERNELS_TYPED_WEIGHTS_H_

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/kernels/kernel_test.h"

namespace gestus::test {

enum class Type { kBf16, kI8 };

inline const kernels::ProductKernels& Products(const kernels::KernelTable& table, Type type) {
  return type == Type::kBf16 ? *table.bf16 : *table.i8;
}

/// The nearest bf16, ties to even.
inline float RoundToBf16(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return std::bit_cast<float>((bits + 0x7fff + (bits >> 16 & 1)) & 0xffff0000u);
}
inline Matrix RoundToBf16(Matrix m) {
  for (std::size_t i = 0; i < m.rows(); ++i) {
    for (std::size_t j = 0; j < m.cols(); ++j) m(i, j) = RoundToBf16(m(i, j));
  }
  return m;
}

/// A matrix (n, k) of one type, without any gap.
struct TypedWeights {
  Type type;
  std::size_t n, k;
  std::vector<std::uint16_t> bf16;
  std::vector<std::int8_t> i8;
  std::vector<float> scale;

  /// Numbers in [-size, size].
  TypedWeights(Type t, std::size_t rows, std::size_t cols, std::uint32_t seed, float size = 1.0f)
      : type(t), n(rows), k(cols) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-size, size);
    std::uniform_int_distribution<int> whole(-127, 127);
    for (std::size_t i = 0; i < n * k; ++i) {
      if (type == Type::kI8)
        i8.push_back(static_cast<std::int8_t>(whole(generator)));
      else
        bf16.push_back(static_cast<std::uint16_t>(
            std::bit_cast<std::uint32_t>(RoundToBf16(uniform(generator))) >> 16));
    }
    for (std::size_t i = 0; i < n && type == Type::kI8; ++i)
      scale.push_back((1.0f + std::fabs(uniform(generator)) / size) * size / 254.0f);
  }

  const void* data() const {
    return type == Type::kI8 ? static_cast<const void*>(i8.data()) : bf16.data();
  }
  const float* scales() const { return type == Type::kI8 ? scale.data() : nullptr; }
  float operator()(std::size_t row, std::size_t col) const {
    if (type == Type::kI8) return static_cast<float>(i8[row * k + col]) * scale[row];
    return std::bit_cast<float>(static_cast<std::uint32_t>(bf16[row * k + col]) << 16);
  }
};

inline GuardedFloats GuardedBytes(std::size_t bytes) {
  return GuardedFloats((bytes + sizeof(float) - 1) / sizeof(float), 64);
}

inline GuardedFloats PackTyped(const kernels::KernelTable& table, const TypedWeights& w) {
  const kernels::ProductKernels& p = Products(table, w.type);
  GuardedFloats packed = GuardedBytes(p.gemm_packed_size(w.n, w.k));
  p.gemm_pack(packed.data(), w.data(), w.scales(), static_cast<std::ptrdiff_t>(w.k), w.n, w.k);
  return packed;
}

/// The suites run once for each type and instruction set.
class TypedTest : public testing::TestWithParam<std::tuple<Type, Isa>> {
 protected:
  void SetUp() override {
    const Isa isa = std::get<1>(GetParam());
    table_ = kernels::TableFor(isa);
    if (table_ == nullptr)
      GTEST_SKIP() << "this machine or this build has no " << kernels::IsaName(isa);
  }
  Type type() const { return std::get<0>(GetParam()); }
  const kernels::ProductKernels& products() const { return Products(*table_, type()); }
  const kernels::ProductKernels& reference() const { return Products(*reference_, type()); }

  const kernels::KernelTable* table_ = nullptr;
  const kernels::KernelTable* reference_ = kernels::TableFor(Isa::kScalar);
};

#define GESTUS_TEST_EVERY_TYPE_ON_EVERY_ISA(suite)                                   \
  INSTANTIATE_TEST_SUITE_P(                                                          \
      TypeAndIsa, suite,                                                             \
      testing::Combine(testing::Values(Type::kBf16, Type::kI8),                      \
                       testing::ValuesIn(kernels::kAllIsas)),                        \
      [](const auto& test) {                                                         \
        return std::string(std::get<0>(test.param) == Type::kI8 ? "i8_" : "bf16_") + \
               kernels::IsaName(std::get<1>(test.param));                            \
      })

}  // namespace gestus::test

#endif  // GESTUS_TESTS_KERNELS_TYPED_WEIGHTS_H_
