// Reference versions of the matrix product and of what is built around it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/reference/at.h"
#include "kernels/reference/reference.h"

namespace gestus::kernels::reference {
namespace {

double dot(const float* a, const float* b, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

}  // namespace

std::size_t gemm_packed_size(std::size_t n, std::size_t k) { return n * k; }

void gemm_pack(float* packed, const float* w, std::ptrdiff_t w_stride, std::size_t n,
               std::size_t k) {
  copy_rows(packed, static_cast<std::ptrdiff_t>(k), w, w_stride, n, k);
}

void gemm(const GemmArgs& g) {
  const Epilogue& e = g.epilogue;
  const auto* packed = static_cast<const float*>(g.packed);
  for (std::size_t i = 0; i < g.m; ++i) {
    for (std::size_t j = g.n_begin; j < g.n_end; ++j) {
      double value = dot(&at(g.a, g.a_stride, i, 0), packed + j * g.k, g.k);
      if (e.bias != nullptr) value += e.bias[j];
      value = activation(e.act, value, e.alpha);
      if (e.residual != nullptr) value += at(e.residual, e.residual_stride, i, j);
      at(g.out, g.out_stride, i, j) = static_cast<float>(value);
    }
  }
}

std::size_t attention_scratch(std::size_t, std::size_t, std::size_t, std::size_t) { return 0; }

// The weights of a query are computed again for each chunk of its values rather than stored,
// because the reference asks for no scratch.
void attention(const AttentionArgs& a) {
  constexpr double kLowest = -std::numeric_limits<double>::infinity();
  constexpr std::size_t kChunk = 64;
  const auto score = [&a](std::size_t i, std::size_t j) {
    if (a.causal && j > a.first_row + i) return kLowest;
    const float* query = &at(a.q, a.q_stride, i, 0);
    const double product = a.scale * dot(query, &at(a.k, a.k_stride, j, 0), a.head_dim);
    return product + (a.key_bias != nullptr ? a.key_bias[j] : 0.0f);
  };
  for (std::size_t i = 0; i < a.rows; ++i) {
    double top = kLowest;
    for (std::size_t j = 0; j < a.keys; ++j) top = std::max(top, score(i, j));
    if (top == kLowest) top = 0.0;
    for (std::size_t c0 = 0; c0 < a.value_dim; c0 += kChunk) {
      const std::size_t count = std::min(kChunk, a.value_dim - c0);
      double sum = 0.0, values[kChunk] = {};
      for (std::size_t j = 0; j < a.keys; ++j) {
        const double weight = std::exp(score(i, j) - top);
        sum += weight;
        for (std::size_t c = 0; c < count; ++c)
          values[c] += weight * at(a.v, a.v_stride, j, c0 + c);
      }
      for (std::size_t c = 0; c < count; ++c) {
        at(a.out, a.out_stride, i, c0 + c) = static_cast<float>(sum == 0.0 ? 0.0 : values[c] / sum);
      }
    }
  }
}

std::size_t lstm_packed_size(std::size_t hidden) { return 4 * hidden * hidden; }

void lstm_pack(float* packed, const float* w_hh, std::size_t hidden) {
  gemm_pack(packed, w_hh, static_cast<std::ptrdiff_t>(hidden), 4 * hidden, hidden);
}

void lstm_cell(const LstmStepArgs& s, std::size_t u, const double (&gate)[4]) {
  const double input = activation(Activation::kSigmoid, gate[0], 0.0);
  const double forget = activation(Activation::kSigmoid, gate[1], 0.0);
  const double output = activation(Activation::kSigmoid, gate[3], 0.0);
  const double cell = forget * s.c[u] + input * std::tanh(gate[2]);
  s.c[u] = static_cast<float>(cell);
  s.h_out[u] = static_cast<float>(output * std::tanh(cell));
}

void lstm_step(const LstmStepArgs& s) {
  const auto* packed = static_cast<const float*>(s.packed);
  for (std::size_t u = s.unit_begin; u < s.unit_end; ++u) {
    double gate[4];
    for (std::size_t g = 0; g < 4; ++g) {
      const std::size_t row = g * s.hidden + u;
      gate[g] = s.x_proj[row] + dot(packed + row * s.hidden, s.h_in, s.hidden);
    }
    lstm_cell(s, u, gate);
  }
}

void conv1d(float* y, const float* x, const float* w, const float* bias, std::size_t length,
            std::size_t in, std::size_t out, std::size_t kernel, std::size_t step,
            std::size_t pad) {
  const std::size_t frames = (length + 2 * pad - kernel) / step + 1;
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t o = 0; o < out; ++o) {
      double sum = bias[o];
      for (std::size_t i = 0; i < kernel; ++i) {
        const std::size_t padded = t * step + i;  // frame of the zero-padded input
        if (padded < pad || padded >= length + pad) continue;
        sum += dot(x + (padded - pad) * in, w + (o * kernel + i) * in, in);
      }
      y[t * out + o] = static_cast<float>(sum);
    }
  }
}

}  // namespace gestus::kernels::reference
