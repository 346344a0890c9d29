// Reference versions of the products with bf16 and 8-bit weights.  Packed weights are the weights,
// for i8 with the scales behind them.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernels/reference/at.h"
#include "kernels/reference/reference.h"

namespace gestus::kernels::reference {
namespace {

float widened(std::uint16_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits) << 16);
}

/// A weight matrix in either type.  Sums of bf16 weights are those of float32 weights, in double;
/// those of i8 weights are whole numbers.
struct Bf16Weights {
  using Element = std::uint16_t;
  static constexpr bool kScaled = false;
};
struct I8Weights {
  using Element = std::int8_t;
  static constexpr bool kScaled = true;
};

template <class W>
std::size_t packed_size(std::size_t n, std::size_t k) {
  const std::size_t weights = (n * k * sizeof(typename W::Element) + 3) / 4 * 4;
  return weights + (W::kScaled ? n * sizeof(float) : 0);
}

template <class W>
void pack(void* packed, const void* w, const float* scale, std::ptrdiff_t w_stride, std::size_t n,
          std::size_t k) {
  auto* to = static_cast<typename W::Element*>(packed);
  const auto* from = static_cast<const typename W::Element*>(w);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < k; ++j) to[i * k + j] = at(from, w_stride, i, j);
  }
  if (W::kScaled) {
    std::byte* scales = static_cast<std::byte*>(packed) + packed_size<W>(n, k) - n * sizeof(float);
    std::memcpy(scales, scale, n * sizeof(float));
  }
}

template <class W>
std::size_t scratch(std::size_t, std::size_t k) {
  return W::kScaled ? k : 0;
}

/// q = round(x * 127 / max|x|), ties to even, and the scale max|x| / 127: zero for rows that are
/// next to nothing, NaN for those that are not finite.
float quantise(std::int8_t* q, const float* x, std::size_t k) {
  float largest = 0.0f;
  bool finite = true;
  for (std::size_t i = 0; i < k; ++i) {
    largest = std::fmax(largest, std::fabs(x[i]));
    finite = finite && std::isfinite(x[i]);
  }
  const bool zero = !finite || largest < 0x1p-100f;
  const float factor = zero ? 0.0f : 127.0f / largest;
  for (std::size_t i = 0; i < k; ++i) {
    q[i] = zero ? std::int8_t{0} : static_cast<std::int8_t>(std::nearbyint(x[i] * factor));
  }
  if (!finite) return std::numeric_limits<float>::quiet_NaN();
  return zero ? 0.0f : largest / 127.0f;
}

/// Products of one row with rows of the packed weights.
template <class W>
class Row {
 public:
  Row(void* room, const float* x, std::size_t k) : x_(x), k_(k) {
    if constexpr (W::kScaled) {
      q_ = static_cast<std::int8_t*>(room);
      scale_ = quantise(static_cast<std::int8_t*>(room), x, k);
    }
  }

  /// With row j of the n that are packed.
  double Times(const void* packed, std::size_t n, std::size_t j) const {
    const auto* w = static_cast<const typename W::Element*>(packed) + j * k_;
    if constexpr (W::kScaled) {
      std::int32_t sum = 0;
      for (std::size_t i = 0; i < k_; ++i) sum += std::int32_t{q_[i]} * w[i];
      const std::byte* end = static_cast<const std::byte*>(packed) + packed_size<W>(n, k_);
      float w_scale;
      std::memcpy(&w_scale, end - (n - j) * sizeof(float), sizeof w_scale);
      return static_cast<float>(sum) * scale_ * w_scale;
    } else {
      double sum = 0.0;
      for (std::size_t i = 0; i < k_; ++i) sum += static_cast<double>(x_[i]) * widened(w[i]);
      return sum;
    }
  }

 private:
  const float* x_;
  std::size_t k_;
  const std::int8_t* q_ = nullptr;
  float scale_ = 1.0f;
};

template <class W>
void gemm(const GemmArgs& g) {
  const Epilogue& e = g.epilogue;
  for (std::size_t i = 0; i < g.m; ++i) {
    const Row<W> row(g.scratch, &at(g.a, g.a_stride, i, 0), g.k);
    for (std::size_t j = g.n_begin; j < g.n_end; ++j) {
      const double product = row.Times(g.packed, g.n, j);
      // What is exact before stays so: the epilogue of i8 rounds as those of the vectors do.
      const double sum = product + (e.bias != nullptr ? e.bias[j] : 0.0f);
      double value = activation(e.act, W::kScaled ? static_cast<float>(sum) : sum, e.alpha);
      if (W::kScaled) value = static_cast<float>(value);
      if (e.residual != nullptr) value += at(e.residual, e.residual_stride, i, j);
      at(g.out, g.out_stride, i, j) = static_cast<float>(value);
    }
  }
}

template <class W>
std::size_t lstm_packed_size(std::size_t hidden) {
  return packed_size<W>(4 * hidden, hidden);
}

template <class W>
void lstm_pack(void* packed, const void* w_hh, const float* scale, std::size_t hidden) {
  pack<W>(packed, w_hh, scale, static_cast<std::ptrdiff_t>(hidden), 4 * hidden, hidden);
}

template <class W>
void lstm_step(const LstmStepArgs& s) {
  const Row<W> h(s.scratch, s.h_in, s.hidden);
  for (std::size_t u = s.unit_begin; u < s.unit_end; ++u) {
    double gate[4];
    for (std::size_t g = 0; g < 4; ++g) {
      const std::size_t row = g * s.hidden + u;
      gate[g] = s.x_proj[row] + h.Times(s.packed, 4 * s.hidden, row);
    }
    lstm_cell(s, u, gate);
  }
}

template <class W>
void gather(float* y, std::ptrdiff_t y_stride, const void* table, const float* scale,
            const std::int32_t* ids, std::size_t n, std::size_t cols, std::size_t vocabulary,
            float factor) {
  const auto* from = static_cast<const typename W::Element*>(table);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t id = ids[i];
    const bool known = id >= 0 && id < static_cast<std::int64_t>(vocabulary);
    for (std::size_t j = 0; j < cols; ++j) {
      float value = 0.0f;
      if (known) {
        const auto row = static_cast<std::size_t>(id);
        if constexpr (W::kScaled)
          value = static_cast<float>(from[row * cols + j]) * scale[row];
        else
          value = widened(from[row * cols + j]);
      }
      at(y, y_stride, i, j) = factor * value;
    }
  }
}

template <class W>
constexpr ProductKernels Products() {
  return {
      "reference",
      packed_size<W>,
      pack<W>,
      scratch<W>,
      gemm<W>,
      gemm<W>,  // one row is no special case here
      lstm_packed_size<W>,
      lstm_pack<W>,
      lstm_step<W>,
      gather<W>,
      nullptr,
      nullptr,
  };
}

}  // namespace

constinit const ProductKernels kBf16 = Products<Bf16Weights>();
constinit const ProductKernels kI8 = Products<I8Weights>();

}  // namespace gestus::kernels::reference
