#include "models/styles/distance.h"

#include <algorithm>
#include <cmath>

namespace gestus::styles {
namespace {

double Dot(std::span<const float> x, std::span<const float> y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += static_cast<double>(x[i]) * y[i];
  return sum;
}

}  // namespace

double Norm(std::span<const float> x) { return std::sqrt(Dot(x, x)); }

std::optional<double> CosineDistance(std::span<const float> x, std::span<const float> y) {
  const double lengths = Norm(x) * Norm(y);
  if (lengths == 0) return std::nullopt;
  return std::clamp(1 - Dot(x, y) / lengths, 0.0, 2.0);
}

double EuclideanDistance(std::span<const float> x, std::span<const float> y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = static_cast<double>(x[i]) - y[i];
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

std::span<const float> ValuesOf(const Style& style, const Part& part) {
  return std::span(style.values)
      .subspan(static_cast<std::size_t>(part.begin), static_cast<std::size_t>(part.width));
}

Rows RowsOf(const std::vector<Named>& styles, const Part& part) {
  Rows rows;
  for (const Named& named : styles) rows.push_back(ValuesOf(named.style, part));
  return rows;
}

std::vector<Part> WholeAndParts(const std::vector<Named>& styles) {
  std::vector<Part> parts;
  if (styles.empty()) return parts;
  parts.push_back({"style", 0, static_cast<std::int64_t>(styles.front().style.values.size())});
  for (const Named& named : styles) {
    if (named.style.parts.empty()) continue;
    parts.insert(parts.end(), named.style.parts.begin(), named.style.parts.end());
    break;
  }
  return parts;
}

}  // namespace gestus::styles
