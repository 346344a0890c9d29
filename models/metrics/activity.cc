#include "models/metrics/activity.h"

#include <algorithm>

namespace gestus::metrics {
namespace {

struct Side {
  double sum = 0, active = 0, inactive = 0;

  /// Adds a value and returns it as the threshold leaves it.
  float Add(float value, float threshold) {
    const bool on = value > threshold;
    sum += on ? value : 0.0f;
    (on ? active : inactive) += 1;
    return on ? value : 0.0f;
  }
};

Measure Percent(double part, double whole) { return Ratio(100 * part, whole); }

}  // namespace

Activity ActivityOf(std::span<const float> predicted, std::span<const float> truth,
                    float threshold) {
  const std::size_t n = std::min(predicted.size(), truth.size());
  Side p, t;
  double equal_values = 0, equal_states = 0;
  for (std::size_t i = 0; i < n; ++i) {
    equal_values += p.Add(predicted[i], threshold) == t.Add(truth[i], threshold);
    equal_states += (predicted[i] > threshold) == (truth[i] > threshold);
  }
  const auto all = static_cast<double>(n);
  return {.hit_intensity = Percent(p.sum, t.sum),
          .hit_count = Percent(p.active, t.active),
          .non_hit = Percent(p.inactive, t.inactive),
          .accuracy_intensity = Percent(equal_values, all),
          .accuracy_count = Percent(equal_states, all)};
}

}  // namespace gestus::metrics
