// Principal components, by the eigenvectors of the matrix of inner products: there are fewer styles
// than values.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "models/styles/map.h"

namespace gestus::styles {

PrincipalMap MapByComponents(const Rows& rows) {
  PrincipalMap map;
  map.points.resize(rows.size());
  if (rows.size() < 2) return map;
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd x(n, static_cast<Eigen::Index>(rows[0].size()));
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < row.size(); ++k) x(i, static_cast<Eigen::Index>(k)) = row[k];
  }
  x.rowwise() -= x.colwise().mean().eval();
  const double variance = x.squaredNorm();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(x * x.transpose());
  constexpr double kNothing = 1e-14;  // of the variance: rounding
  for (Eigen::Index axis = 0; axis < std::min<Eigen::Index>(2, n); ++axis) {
    const double value = solver.eigenvalues()(n - 1 - axis);
    if (!(value > kNothing * variance)) continue;
    Eigen::VectorXd along = solver.eigenvectors().col(n - 1 - axis) * std::sqrt(value);
    // Coordinates of the same size but for rounding: the first of them decides.
    Eigen::Index largest = 0;
    for (Eigen::Index i = 1; i < n; ++i)
      if (std::fabs(along(i)) > std::fabs(along(largest)) * (1 + 1e-9)) largest = i;
    if (along(largest) < 0) along = -along;
    for (Eigen::Index i = 0; i < n; ++i)
      map.points[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)] = along(i);
    map.explained[static_cast<std::size_t>(axis)] = value / variance;
  }
  return map;
}

}  // namespace gestus::styles
