// Loops over elements, nothing cleverer.
#include "tests/engine/dense.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace gestus::test {

std::vector<float> Noise(std::int64_t n, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> x(static_cast<std::size_t>(n));
  for (float& value : x) value = static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f;
  return x;
}

TensorView Tensors::Make(Shape shape, std::uint32_t seed, float scale) {
  std::vector<float> values = Noise(shape.NumElements(), seed);
  for (float& value : values) value *= scale;
  return Of(shape, std::move(values));
}

TensorView Tensors::Of(Shape shape, std::vector<float> values) {
  all_.push_back(std::make_unique<std::vector<float>>(std::move(values)));
  return {DType::kF32, shape, all_.back()->data()};
}

template <class T>
T* Tensors::Keep(std::size_t count) {
  const std::size_t floats = (count * sizeof(T) + sizeof(float) - 1) / sizeof(float);
  all_.push_back(std::make_unique<std::vector<float>>(floats));
  return reinterpret_cast<T*>(all_.back()->data());
}

TensorView Tensors::As(DType dtype, const TensorView& from) {
  if (dtype == DType::kF32) return from;
  TensorView to = from;
  to.dtype = dtype;
  const auto count = static_cast<std::size_t>(from.shape.NumElements());
  const auto rows = static_cast<std::size_t>(from.shape[0]), cols = count / rows;
  if (dtype == DType::kBF16) {
    auto* bits = Keep<std::uint16_t>(count);
    for (std::size_t i = 0; i < count; ++i)
      bits[i] = static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(from.f32()[i]) >> 16);
    to.data = bits;
    return to;
  }
  auto* whole = Keep<std::int8_t>(count);
  auto* scale = Keep<float>(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const float* x = from.f32() + r * cols;
    float largest = 1e-6f;
    for (std::size_t c = 0; c < cols; ++c) largest = std::max(largest, std::fabs(x[c]));
    scale[r] = largest / 127.0f;
    for (std::size_t c = 0; c < cols; ++c)
      whole[r * cols + c] = static_cast<std::int8_t>(std::lround(x[c] / scale[r]));
  }
  to.data = whole;
  to.scale = scale;
  return to;
}

Dense ToDense(const TensorView& view) {
  if (view.data == nullptr) return {};
  Dense d(view.shape.Rows(), view.shape.Cols());
  std::copy_n(view.f32(), d.v.size(), d.v.begin());
  return d;
}

Dense ToDense(const ValueView& view) {
  Dense d(view.shape.Rows(), view.shape.Cols());
  for (std::int64_t r = 0; r < d.rows; ++r) {
    for (std::int64_t c = 0; c < d.cols; ++c) d.at(r, c) = view.f32[r * view.row_stride + c];
  }
  return d;
}

Dense LinearOf(const Dense& x, const Dense& w, const Dense& bias) {
  Dense y(x.rows, w.rows);
  for (std::int64_t r = 0; r < y.rows; ++r) {
    for (std::int64_t o = 0; o < y.cols; ++o) {
      double sum = bias.cols > 0 ? bias.v[static_cast<std::size_t>(o)] : 0;
      for (std::int64_t i = 0; i < x.cols; ++i) sum += x.at(r, i) * w.at(o, i);
      y.at(r, o) = sum;
    }
  }
  return y;
}

Dense ActivateOf(Dense x, Activation act, double alpha) {
  const double root2 = std::sqrt(2.0), root2_over_pi = std::sqrt(2.0 / 3.14159265358979323846);
  for (double& v : x.v) {
    switch (act) {
      case Activation::kNone:
        break;
      case Activation::kRelu:
        v = std::max(v, 0.0);
        break;
      case Activation::kLeakyRelu:
        v = v < 0 ? alpha * v : v;
        break;
      case Activation::kGeluErf:
        v = v * (1 + std::erf(v / root2)) / 2;
        break;
      case Activation::kGeluTanh:
        v = v * (1 + std::tanh(root2_over_pi * (v + 0.044715 * v * v * v))) / 2;
        break;
      case Activation::kTanh:
        v = std::tanh(v);
        break;
      case Activation::kSigmoid:
        v = 1 / (1 + std::exp(-v));
        break;
    }
  }
  return x;
}

Dense AddOf(Dense a, const Dense& b) {
  for (std::int64_t r = 0; r < a.rows; ++r) {
    for (std::int64_t c = 0; c < a.cols; ++c) a.at(r, c) += b.at(b.rows == 1 ? 0 : r, c);
  }
  return a;
}

Dense LayerNormOf(const Dense& x, const Dense& gamma, const Dense& beta, double eps) {
  Dense y = x;
  for (std::int64_t r = 0; r < x.rows; ++r) {
    double mean = 0, variance = 0;
    for (std::int64_t c = 0; c < x.cols; ++c) mean += x.at(r, c);
    mean /= static_cast<double>(x.cols);
    for (std::int64_t c = 0; c < x.cols; ++c) variance += std::pow(x.at(r, c) - mean, 2);
    variance /= static_cast<double>(x.cols);
    for (std::int64_t c = 0; c < x.cols; ++c) {
      y.at(r, c) = (x.at(r, c) - mean) / std::sqrt(variance + eps) * gamma.at(0, c) + beta.at(0, c);
    }
  }
  return y;
}

Dense SoftmaxOf(Dense x) {
  for (std::int64_t r = 0; r < x.rows; ++r) {
    double largest = -std::numeric_limits<double>::infinity(), sum = 0;
    for (std::int64_t c = 0; c < x.cols; ++c) largest = std::max(largest, x.at(r, c));
    for (std::int64_t c = 0; c < x.cols; ++c) sum += std::exp(x.at(r, c) - largest);
    for (std::int64_t c = 0; c < x.cols; ++c) x.at(r, c) = std::exp(x.at(r, c) - largest) / sum;
  }
  return x;
}

Dense RowsOf(const Dense& x, std::int64_t begin, std::int64_t count) {
  Dense y(count, x.cols);
  for (std::int64_t r = 0; r < count; ++r) {
    for (std::int64_t c = 0; c < x.cols; ++c) y.at(r, c) = x.at(begin + r, c);
  }
  return y;
}

Dense ColumnsOf(const Dense& x, std::int64_t begin, std::int64_t count) {
  Dense y(x.rows, count);
  for (std::int64_t r = 0; r < x.rows; ++r) {
    for (std::int64_t c = 0; c < count; ++c) y.at(r, c) = x.at(r, begin + c);
  }
  return y;
}

Dense SideBySide(const std::vector<Dense>& parts) {
  std::int64_t cols = 0;
  for (const Dense& p : parts) cols += p.cols;
  Dense y(parts[0].rows, cols);
  std::int64_t at = 0;
  for (const Dense& p : parts) {
    for (std::int64_t r = 0; r < p.rows; ++r) {
      for (std::int64_t c = 0; c < p.cols; ++c) y.at(r, at + c) = p.at(r, c);
    }
    at += p.cols;
  }
  return y;
}

Dense OneBelowTheOther(const std::vector<Dense>& parts) {
  Dense y(0, parts[0].cols);
  for (const Dense& p : parts) {
    y.v.insert(y.v.end(), p.v.begin(), p.v.end());
    y.rows += p.rows;
  }
  return y;
}

Dense AttentionOf(const Dense& q, const Dense& k, const Dense& v, const AttentionFormula& f) {
  const std::int64_t dq = q.cols / f.heads, dv = v.cols / f.heads;
  const double scale = f.scale != 0 ? f.scale : 1 / std::sqrt(static_cast<double>(dq));
  std::vector<Dense> heads;
  for (int h = 0; h < f.heads; ++h) {
    Dense scores = LinearOf(ColumnsOf(q, h * dq, dq), ColumnsOf(k, h * dq, dq), {});
    for (std::int64_t i = 0; i < scores.rows; ++i) {
      for (std::int64_t j = 0; j < scores.cols; ++j) {
        double& s = scores.at(i, j);
        s *= scale;
        if (!f.key_bias.empty()) s += f.key_bias[static_cast<std::size_t>(j)];
        if (f.causal && j > i) s = -std::numeric_limits<double>::infinity();
      }
    }
    const Dense weights = SoftmaxOf(scores), values = ColumnsOf(v, h * dv, dv);
    Dense out(q.rows, dv);
    for (std::int64_t i = 0; i < q.rows; ++i) {
      for (std::int64_t c = 0; c < dv; ++c) {
        for (std::int64_t j = 0; j < k.rows; ++j)
          out.at(i, c) += weights.at(i, j) * values.at(j, c);
      }
    }
    heads.push_back(out);
  }
  return SideBySide(heads);
}

Dense LstmOf(const Dense& x, const Dense& w_ih, const Dense& w_hh, const Dense& bias,
             bool reverse) {
  const std::int64_t hidden = w_hh.cols;
  Dense y(x.rows, hidden), h(1, hidden), c(1, hidden);
  for (std::int64_t step = 0; step < x.rows; ++step) {
    const std::int64_t t = reverse ? x.rows - 1 - step : step;
    const Dense gates = AddOf(LinearOf(RowsOf(x, t, 1), w_ih, bias), LinearOf(h, w_hh, {}));
    const auto gate = [&](std::int64_t which, Activation act) {
      return ActivateOf(ColumnsOf(gates, which * hidden, hidden), act, 0);
    };
    const Dense i = gate(0, Activation::kSigmoid), f = gate(1, Activation::kSigmoid);
    const Dense g = gate(2, Activation::kTanh), o = gate(3, Activation::kSigmoid);
    for (std::int64_t u = 0; u < hidden; ++u) {
      c.at(0, u) = f.at(0, u) * c.at(0, u) + i.at(0, u) * g.at(0, u);
      h.at(0, u) = o.at(0, u) * std::tanh(c.at(0, u));
      y.at(t, u) = h.at(0, u);
    }
  }
  return y;
}

Dense Conv1dOf(const Dense& x, const Dense& w, const Dense& bias, std::int64_t k,
               std::int64_t stride, std::int64_t before, std::int64_t after) {
  const std::int64_t rows = (x.rows + before + after - k) / stride + 1;
  Dense y(rows, w.rows);
  for (std::int64_t t = 0; t < rows; ++t) {
    for (std::int64_t o = 0; o < w.rows; ++o) {
      double sum = bias.cols > 0 ? bias.v[static_cast<std::size_t>(o)] : 0;
      for (std::int64_t i = 0; i < x.cols; ++i) {
        for (std::int64_t j = 0; j < k; ++j) {
          const std::int64_t from = t * stride + j - before;
          if (from >= 0 && from < x.rows) sum += w.at(o, i * k + j) * x.at(from, i);
        }
      }
      y.at(t, o) = sum;
    }
  }
  return y;
}

}  // namespace gestus::test
