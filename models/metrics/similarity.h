// How near a generated motion is to another one, frame by frame (thesis 7.5.1).
#ifndef GESTUS_MODELS_METRICS_SIMILARITY_H_
#define GESTUS_MODELS_METRICS_SIMILARITY_H_

#include <cstdint>
#include <span>

#include "models/metrics/measure.h"

namespace gestus::metrics {

/// Equation 7.5 with all coordinates of all frames as one vector: content preservation is
/// 100 * a.b / (|a| |b|), -100 to 100.  The thesis calls it a distance; it is a similarity.
/// Sums of several sequences can be added before Percent is asked, which then is that of their
/// vectors end to end.
struct ContentSums {
  double product = 0, source_square = 0, prediction_square = 0;

  void Add(const ContentSums& other);
  /// Undefined where either side has no values or only zeros.
  Measure Percent() const;
};
/// Of the first n values of both.
ContentSums SumContent(std::span<const float> source, std::span<const float> prediction);

constexpr double kMaxOrder = 100;

/// Minkowski distances of order p, (sum |a_i - b_i|^p)^(1/p), each with its own reading of the
/// thesis' "average distance between all the body joints and facial landmarks".
struct DistanceSums {
  double point_sum = 0, frame_sum = 0;
  std::int64_t points = 0, frames = 0;

  void Add(const DistanceSums& other);
  /// Of one point to its counterpart, the mean over points and frames.
  Measure PerPoint() const { return Ratio(point_sum, static_cast<double>(points)); }
  /// Of all coordinates of a frame as one vector, the mean over frames.
  Measure PerFrame() const { return Ratio(frame_sum, static_cast<double>(frames)); }
};
/// `a` and `b` (frames, 2 * points), x of all then y of all; `order` from 1 to kMaxOrder.  Both
/// are undefined without frames or points.
DistanceSums SumDistances(std::span<const float> a, std::span<const float> b, std::int64_t points,
                          double order);

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_SIMILARITY_H_
