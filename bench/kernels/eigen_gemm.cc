// Eigen's matrix product for comparison, compiled once per instruction set with `Eigen` renamed to
// Eigen_<isa>, so that none of its weak functions meets another instruction set's.
#include <Eigen/Dense>
#include <cstddef>

#define GESTUS_CONCAT_(a, b) a##b
#define GESTUS_CONCAT(a, b) GESTUS_CONCAT_(a, b)

namespace gestus::bench {

/// out (m, n) = a (m, k) * w (n, k)^T
void GESTUS_CONCAT(EigenGemm_, GESTUS_ISA)(float* out, const float* a, const float* w,
                                           std::size_t m, std::size_t n, std::size_t k,
                                           int threads) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto index = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  Eigen::setNbThreads(threads);
  Eigen::Map<Matrix>(out, index(m), index(n)).noalias() =
      Eigen::Map<const Matrix>(a, index(m), index(k)) *
      Eigen::Map<const Matrix>(w, index(n), index(k)).transpose();
}

}  // namespace gestus::bench
