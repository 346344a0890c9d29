// What every measure of the thesis' evaluations gives: a number, or nothing where it has none.
#ifndef GESTUS_MODELS_METRICS_MEASURE_H_
#define GESTUS_MODELS_METRICS_MEASURE_H_

#include <cmath>
#include <optional>

namespace gestus::metrics {

/// Empty: undefined, as a correlation with a signal that never changes is.  Never NaN or infinite.
using Measure = std::optional<double>;

/// `value`, undefined when it is not finite.
inline Measure Defined(double value) {
  return std::isfinite(value) ? Measure(value) : std::nullopt;
}

/// part / whole, undefined when that divides by zero.
inline Measure Ratio(double part, double whole) {
  return whole == 0 ? std::nullopt : Defined(part / whole);
}

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_MEASURE_H_
