// Reference versions of the kernels that work on rows and elements.
#include <cmath>
#include <limits>

#include "kernels/reference/at.h"
#include "kernels/reference/reference.h"

namespace gestus::kernels::reference {

double activation(Activation act, double x, double alpha) {
  constexpr double kPi = 3.14159265358979323846;
  switch (act) {
    case Activation::kNone:
      return x;
    case Activation::kRelu:
      return x < 0.0 ? 0.0 : x;
    case Activation::kLeakyRelu:
      return x < 0.0 ? alpha * x : x;
    case Activation::kGeluErf:
      // erfc keeps the digits of the negative tail, which is zero long before -40.
      return x < -40.0 ? 0.0 : 0.5 * x * std::erfc(-x / std::sqrt(2.0));
    case Activation::kGeluTanh:
      if (x < -40.0) return 0.0;
      return 0.5 * x * (1.0 + std::tanh(std::sqrt(2.0 / kPi) * (x + 0.044715 * x * x * x)));
    case Activation::kTanh:
      return std::tanh(x);
    case Activation::kSigmoid:
      return 1.0 / (1.0 + std::exp(-x));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void layer_norm(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                const float* gamma, const float* beta, float eps, std::size_t rows,
                std::size_t cols) {
  const double count = static_cast<double>(cols);
  for (std::size_t r = 0; r < rows; ++r) {
    double mean = 0.0, variance = 0.0;
    for (std::size_t j = 0; j < cols; ++j) mean += at(x, x_stride, r, j);
    mean /= count;
    for (std::size_t j = 0; j < cols; ++j) {
      variance += std::pow(at(x, x_stride, r, j) - mean, 2.0) / count;
    }
    const double deviation = std::sqrt(variance + eps);
    for (std::size_t j = 0; j < cols; ++j) {
      const double normal = (at(x, x_stride, r, j) - mean) / deviation;
      at(y, y_stride, r, j) = static_cast<float>(normal * gamma[j] + beta[j]);
    }
  }
}

void softmax(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
             std::size_t rows, std::size_t cols) {
  constexpr double kLowest = -std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < rows; ++r) {
    double top = kLowest, sum = 0.0;
    for (std::size_t j = 0; j < cols; ++j) {
      if (at(x, x_stride, r, j) > top) top = at(x, x_stride, r, j);
    }
    if (top == kLowest) top = 0.0;
    for (std::size_t j = 0; j < cols; ++j) sum += std::exp(at(x, x_stride, r, j) - top);
    for (std::size_t j = 0; j < cols; ++j) {
      const double e = std::exp(at(x, x_stride, r, j) - top);
      at(y, y_stride, r, j) = static_cast<float>(sum == 0.0 ? 0.0 : e / sum);
    }
  }
}

void activate(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
              std::size_t rows, std::size_t cols, Activation act, float alpha) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t j = 0; j < cols; ++j) {
      at(y, y_stride, r, j) = static_cast<float>(activation(act, at(x, x_stride, r, j), alpha));
    }
  }
}

void add(float* y, std::ptrdiff_t y_stride, const float* a, std::ptrdiff_t a_stride, const float* b,
         std::ptrdiff_t b_stride, std::size_t rows, std::size_t cols) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t j = 0; j < cols; ++j) {
      at(y, y_stride, r, j) = at(a, a_stride, r, j) + at(b, b_stride, r, j);
    }
  }
}

void affine(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
            const float* scale, const float* shift, std::size_t rows, std::size_t cols) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t j = 0; j < cols; ++j) {
      const double product = static_cast<double>(at(x, x_stride, r, j)) * scale[j];
      at(y, y_stride, r, j) = static_cast<float>(product + shift[j]);
    }
  }
}

void copy_rows(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
               std::size_t rows, std::size_t cols) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t j = 0; j < cols; ++j) at(y, y_stride, r, j) = at(x, x_stride, r, j);
  }
}

void mean_rows(float* y, const float* x, std::ptrdiff_t x_stride, std::size_t rows,
               std::size_t cols) {
  for (std::size_t j = 0; j < cols; ++j) {
    double sum = 0.0;
    for (std::size_t r = 0; r < rows; ++r) sum += at(x, x_stride, r, j);
    y[j] = static_cast<float>(sum / static_cast<double>(rows));
  }
}

void gather(float* y, std::ptrdiff_t y_stride, const float* table, std::ptrdiff_t table_stride,
            const std::int32_t* ids, std::size_t n, std::size_t cols, std::size_t vocabulary,
            float scale) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t id = ids[i];
    const bool known = id >= 0 && id < static_cast<std::int64_t>(vocabulary);
    for (std::size_t j = 0; j < cols; ++j) {
      at(y, y_stride, i, j) =
          known ? scale * at(table, table_stride, static_cast<std::size_t>(id), j) : 0.0f;
    }
  }
}

void patches(const PatchArgs& p) {
  for (std::size_t a = 0; a < p.ph; ++a) {
    for (std::size_t b = 0; b < p.pw; ++b) {
      for (std::size_t i = 0; i < p.kh; ++i) {
        for (std::size_t j = 0; j < p.kw; ++j) {
          const auto h = static_cast<std::ptrdiff_t>(a * p.step_h + i);
          const auto w = static_cast<std::ptrdiff_t>(b * p.step_w + j);
          at(p.out, p.out_stride, a * p.pw + b, i * p.kw + j) =
              p.image[h * p.stride_h + w * p.stride_w];
        }
      }
    }
  }
}

}  // namespace gestus::kernels::reference
