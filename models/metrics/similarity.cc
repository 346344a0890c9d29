#include "models/metrics/similarity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gestus::metrics {
namespace {

// Scaled by the largest difference, so that no power of it overflows or vanishes.
double Minkowski(std::span<const double> differences, double order) {
  const double largest = *std::max_element(differences.begin(), differences.end());
  if (largest == 0) return 0;
  double sum = 0;
  for (const double difference : differences) sum += std::pow(difference / largest, order);
  return largest * std::pow(sum, 1 / order);
}

}  // namespace

void ContentSums::Add(const ContentSums& other) {
  product += other.product;
  source_square += other.source_square;
  prediction_square += other.prediction_square;
}

Measure ContentSums::Percent() const {
  const Measure cosine = Ratio(product, std::sqrt(source_square) * std::sqrt(prediction_square));
  return cosine ? Measure(100 * std::clamp(*cosine, -1.0, 1.0)) : cosine;
}

ContentSums SumContent(std::span<const float> source, std::span<const float> prediction) {
  ContentSums sums;
  for (std::size_t i = 0; i < std::min(source.size(), prediction.size()); ++i) {
    const double s = source[i], p = prediction[i];
    sums.product += s * p;
    sums.source_square += s * s;
    sums.prediction_square += p * p;
  }
  return sums;
}

void DistanceSums::Add(const DistanceSums& other) {
  point_sum += other.point_sum;
  frame_sum += other.frame_sum;
  points += other.points;
  frames += other.frames;
}

DistanceSums SumDistances(std::span<const float> a, std::span<const float> b, std::int64_t points,
                          double order) {
  DistanceSums sums;
  if (points <= 0) return sums;
  const auto n = static_cast<std::size_t>(points);
  std::vector<double> differences(2 * n);
  for (std::size_t row = 0; row + 2 * n <= std::min(a.size(), b.size()); row += 2 * n) {
    for (std::size_t i = 0; i < 2 * n; ++i)
      differences[i] = std::abs(double{a[row + i]} - b[row + i]);
    sums.frame_sum += Minkowski(differences, order);
    for (std::size_t i = 0; i < n; ++i)
      sums.point_sum += Minkowski(std::array{differences[i], differences[n + i]}, order);
    ++sums.frames;
    sums.points += points;
  }
  return sums;
}

}  // namespace gestus::metrics
