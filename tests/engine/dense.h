// Matrices in double precision and the formulas of a network's layers, written down as in the
// papers: what the engine's results are compared with.
#ifndef GESTUS_TESTS_ENGINE_DENSE_H_
#define GESTUS_TESTS_ENGINE_DENSE_H_

#include <cstdint>
#include <vector>

#include "engine/graph.h"
#include "engine/session.h"

namespace gestus::test {

struct Dense {
  std::int64_t rows = 0, cols = 0;
  std::vector<double> v{};

  Dense() = default;
  Dense(std::int64_t r, std::int64_t c) : rows(r), cols(c), v(static_cast<std::size_t>(r * c)) {}
  double& at(std::int64_t r, std::int64_t c) { return v[static_cast<std::size_t>(r * cols + c)]; }
  double at(std::int64_t r, std::int64_t c) const {
    return v[static_cast<std::size_t>(r * cols + c)];
  }
};

/// Numbers in [-1, 1) from a seed, the same on every machine.
std::vector<float> Noise(std::int64_t n, std::uint32_t seed);

/// A tensor of noise that lives as long as the test.
class Tensors {
 public:
  TensorView Make(Shape shape, std::uint32_t seed, float scale = 1.0f);
  TensorView Of(Shape shape, std::vector<float> values);
  /// A float32 tensor rounded to another type, int8 with a scale for each row.
  TensorView As(DType dtype, const TensorView& from);

 private:
  template <class T>
  T* Keep(std::size_t count);

  std::vector<std::unique_ptr<std::vector<float>>> all_;
};

Dense ToDense(const TensorView& view);  ///< all leading dimensions are rows
Dense ToDense(const ValueView& view);   ///< of a matrix

Dense LinearOf(const Dense& x, const Dense& w, const Dense& bias);  ///< no bias: 0 columns
Dense ActivateOf(Dense x, Activation act, double alpha);
Dense AddOf(Dense a, const Dense& b);  ///< b may have one row
Dense LayerNormOf(const Dense& x, const Dense& gamma, const Dense& beta, double eps);
Dense SoftmaxOf(Dense x);
Dense RowsOf(const Dense& x, std::int64_t begin, std::int64_t count);
Dense ColumnsOf(const Dense& x, std::int64_t begin, std::int64_t count);
Dense SideBySide(const std::vector<Dense>& parts);
Dense OneBelowTheOther(const std::vector<Dense>& parts);

struct AttentionFormula {
  int heads = 1;
  double scale = 0;  ///< 0: 1 / sqrt(head width)
  bool causal = false;
  std::vector<double> key_bias{};
};
Dense AttentionOf(const Dense& q, const Dense& k, const Dense& v, const AttentionFormula& f);
Dense LstmOf(const Dense& x, const Dense& w_ih, const Dense& w_hh, const Dense& bias, bool reverse);
/// w (C_out, C_in * k) as PyTorch flattens (C_out, C_in, k).
Dense Conv1dOf(const Dense& x, const Dense& w, const Dense& bias, std::int64_t k,
               std::int64_t stride, std::int64_t before, std::int64_t after);

}  // namespace gestus::test

#endif  // GESTUS_TESTS_ENGINE_DENSE_H_
