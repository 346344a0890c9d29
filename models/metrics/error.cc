#include "models/metrics/error.h"

#include <algorithm>

namespace gestus::metrics {
namespace {

double Mean(std::span<const float> x) {
  double sum = 0;
  for (const float value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

// Told by the values themselves: rounded sums would leave a little variance.
bool Constant(std::span<const float> x) {
  return std::all_of(x.begin(), x.end(), [&](float value) { return value == x.front(); });
}

}  // namespace

Measure Rmse(std::span<const float> predicted, std::span<const float> truth) {
  const std::size_t n = std::min(predicted.size(), truth.size());
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double error = double{predicted[i]} - truth[i];
    sum += error * error;
  }
  const Measure mean = Ratio(sum, static_cast<double>(n));
  return mean ? Measure(std::sqrt(*mean)) : mean;
}

Measure Pearson(std::span<const float> predicted, std::span<const float> truth) {
  const std::size_t n = std::min(predicted.size(), truth.size());
  const auto p = predicted.first(n), t = truth.first(n);
  if (n < 2 || Constant(p) || Constant(t)) return std::nullopt;
  const double mean_p = Mean(p), mean_t = Mean(t);
  double pp = 0, tt = 0, pt = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double dp = p[i] - mean_p, dt = t[i] - mean_t;
    pp += dp * dp;
    tt += dt * dt;
    pt += dp * dt;
  }
  const Measure r = Ratio(pt, std::sqrt(pp) * std::sqrt(tt));
  return r ? Measure(std::clamp(*r, -1.0, 1.0)) : r;
}

}  // namespace gestus::metrics
