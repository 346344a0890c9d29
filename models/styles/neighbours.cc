// Exact t-SNE: neighbours near one another in the plane, whatever lies far apart.
#include <algorithm>
#include <cmath>
#include <limits>

#include "models/styles/map.h"

namespace gestus::styles {
namespace {

using Square = std::vector<double>;  // (n, n)

constexpr double kLeast = 1e-12;      // of a probability
constexpr double kExaggeration = 12;  // of nearness, at first, so that groups can form
constexpr int kExaggerated = 250;     // steps
constexpr int kMostSteps = 3000;
constexpr double kStill = 1e-8;  // gradient at which the map is done
constexpr double kStart = 1e-4;  // deviation of the first map

Square SquaredDistances(const Rows& rows) {
  const std::size_t n = rows.size();
  Square d(n * n);
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = EuclideanDistance(rows[i], rows[j]);
      d[i * n + j] = d[j * n + i] = distance * distance;
      mean += 2 * distance * distance / static_cast<double>(n * (n - 1));
    }
  }
  if (mean > 0)
    for (double& value : d) value /= mean;  // the map does not depend on the unit
  return d;
}

/// p(j|i) = exp(-beta d_ij) / sum for the row `d` of point i; returns the perplexity's logarithm.
double Neighbourhood(const double* d, std::size_t n, std::size_t i, double beta, double* p) {
  double nearest = std::numeric_limits<double>::max(), sum = 0, weighted = 0;
  for (std::size_t j = 0; j < n; ++j)
    if (j != i) nearest = std::min(nearest, d[j]);
  for (std::size_t j = 0; j < n; ++j) {
    p[j] = j == i ? 0 : std::exp(-beta * (d[j] - nearest));
    sum += p[j];
    weighted += p[j] * beta * (d[j] - nearest);
  }
  for (std::size_t j = 0; j < n; ++j) p[j] /= sum;
  return std::log(sum) + weighted / sum;
}

/// Symmetric probabilities whose neighbourhoods have `perplexity`, as far as distances allow.
Square Probabilities(const Square& d, std::size_t n, double perplexity) {
  Square p(n * n);
  const double wanted = std::log(perplexity);
  for (std::size_t i = 0; i < n; ++i) {
    double low = 0, high = std::numeric_limits<double>::infinity(), beta = 1;
    for (int step = 0; step < 100; ++step) {
      if (Neighbourhood(&d[i * n], n, i, beta, &p[i * n]) > wanted) {
        low = beta;
        beta = std::isinf(high) ? 2 * beta : (low + high) / 2;
      } else {
        high = beta;
        beta = (low + high) / 2;
      }
    }
  }
  Square both(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      both[i * n + j] =
          i == j ? 0
                 : std::max((p[i * n + j] + p[j * n + i]) / (2 * static_cast<double>(n)), kLeast);
  return both;
}

/// Kernels 1 / (1 + |y_i - y_j|^2) below the diagonal of `q`; returns the sum over all pairs.
double Kernels(const Points& y, Square* q) {
  const std::size_t n = y.size();
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = y[i][0] - y[j][0], dy = y[i][1] - y[j][1];
      (*q)[i * n + j] = 1 / (1 + dx * dx + dy * dy);
      sum += 2 * (*q)[i * n + j];
    }
  }
  return sum;
}

/// The gradient of the divergence where `p` is `exaggeration` times as large.
void Gradient(const Square& p, const Points& y, double exaggeration, Square* q, Points* gradient) {
  const std::size_t n = y.size();
  const double sum = Kernels(y, q);
  std::fill(gradient->begin(), gradient->end(), std::array<double, 2>{});
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double kernel = (*q)[i * n + j], share = std::max(kernel / sum, kLeast);
      const double pull = 4 * (exaggeration * p[i * n + j] - share) * kernel;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double part = pull * (y[i][axis] - y[j][axis]);
        (*gradient)[i][axis] += part;
        (*gradient)[j][axis] -= part;
      }
    }
  }
}

double Divergence(const Square& p, const Points& y, Square* q) {
  const std::size_t n = y.size();
  const double sum = Kernels(y, q);
  double divergence = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double near = p[i * n + j];
      divergence += 2 * near * std::log(near / std::max((*q)[i * n + j] / sum, kLeast));
    }
  }
  return divergence;
}

Points FirstMap(const Rows& rows) {
  Points y = MapByComponents(rows).points;
  double square = 0;
  for (const auto& point : y) square += point[0] * point[0];
  const double deviation = std::sqrt(square / static_cast<double>(y.size()));
  for (auto& point : y)
    for (double& value : point) value = deviation > 0 ? value * kStart / deviation : 0;
  return y;
}

double Largest(const Points& points) {
  double largest = 0;
  for (const auto& point : points)
    largest = std::max({largest, std::fabs(point[0]), std::fabs(point[1])});
  return largest;
}

}  // namespace

NeighbourMap MapByNeighbours(const Rows& rows) {
  const std::size_t n = rows.size();
  NeighbourMap map;
  map.perplexity = std::min(30.0, static_cast<double>(n - 1) / 3);
  const Square p = Probabilities(SquaredDistances(rows), n, map.perplexity);
  map.points = FirstMap(rows);
  Points gradient(n), speed(n), gain(n, {1, 1});
  Square q(n * n);
  // Belkina et al. 2019: a rate in proportion to the number of points.
  const double rate = static_cast<double>(n) / kExaggeration / 4;
  for (int step = 0; step < kMostSteps; ++step) {
    const bool early = step < kExaggerated;
    Gradient(p, map.points, early ? kExaggeration : 1, &q, &gradient);
    if (!early && Largest(gradient) < kStill) break;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        double& g = gain[i][axis];
        g = gradient[i][axis] * speed[i][axis] < 0 ? g + 0.2 : std::max(g * 0.8, 0.01);
        speed[i][axis] = (early ? 0.5 : 0.8) * speed[i][axis] - rate * g * gradient[i][axis];
        map.points[i][axis] += speed[i][axis];
      }
    }
  }
  map.divergence = Divergence(p, map.points, &q);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double mean = 0;
    for (const auto& point : map.points) mean += point[axis] / static_cast<double>(n);
    for (auto& point : map.points) point[axis] -= mean;
  }
  return map;
}

}  // namespace gestus::styles
