// Whether action units are active when they should be (thesis 5.5.6, after Ong et al. 2017).  An
// action unit is active when its value is greater than 0.5.
//
// The thesis' sentence, "percentage of predicted AU activation with respect to ground truth", can
// be read as counting frames or as adding up intensities.  The code that the author released adds
// up, and only that agrees with Table 5.8, where AHR and NAHR lie on the same side of 100 for some
// units.  Both are here.
#ifndef GESTUS_MODELS_METRICS_ACTIVITY_H_
#define GESTUS_MODELS_METRICS_ACTIVITY_H_

#include <span>

#include "models/metrics/measure.h"

namespace gestus::metrics {

constexpr float kActive = 0.5f;

/// All in percent; of the first n values of both.
struct Activity {
  /// AHR by intensity: 100 * sum of predicted active values / sum of true active values.
  Measure hit_intensity;
  /// AHR by count: 100 * frames predicted active / frames truly active.
  Measure hit_count;
  /// NAHR: 100 * frames predicted inactive / frames truly inactive.  Both readings agree on it.
  Measure non_hit;
  /// Share of frames that are equal once inactive values have become 0: active ones by their very
  /// value, as the released code compares them.
  Measure accuracy_intensity;
  /// Share of frames whose state, active or not, is right.
  Measure accuracy_count;
};

/// Hit ratios are undefined where the truth has no active (no inactive) frame, accuracies without
/// values.
Activity ActivityOf(std::span<const float> predicted, std::span<const float> truth,
                    float threshold = kActive);

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_ACTIVITY_H_
