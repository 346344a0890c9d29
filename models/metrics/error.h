// How far predicted curves are from the true ones, and whether they move together (thesis 5.5.6).
#ifndef GESTUS_MODELS_METRICS_ERROR_H_
#define GESTUS_MODELS_METRICS_ERROR_H_

#include <span>

#include "models/metrics/measure.h"

namespace gestus::metrics {

/// Root mean squared error, sqrt(sum (p - t)^2 / n), in the unit of the values; the first n of
/// both, n of the shorter one.  Undefined without values.
Measure Rmse(std::span<const float> predicted, std::span<const float> truth);

/// Pearson's correlation, sum (p - p')(t - t') / sqrt(sum (p - p')^2 sum (t - t')^2) with p', t'
/// the means, -1 to 1; the first n of both.  Undefined for fewer than two values and where all
/// values of either side are the same.
Measure Pearson(std::span<const float> predicted, std::span<const float> truth);

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_ERROR_H_
