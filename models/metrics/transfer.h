// Transfer strength (thesis 7.5.1, equations 7.3 and 7.4): how often classifier C takes generated
// motion for the target's.
#ifndef GESTUS_MODELS_METRICS_TRANSFER_H_
#define GESTUS_MODELS_METRICS_TRANSFER_H_

#include <cstdint>
#include <span>

#include "models/metrics/measure.h"

namespace gestus::metrics {

/// Equation 7.3: up to 0.5 C has seen the source's style, above it the target's.
constexpr float kTargetStyle = 0.5f;

struct TransferStrength {
  std::int64_t right = 0;  ///< pieces that C takes for the target's
  std::int64_t total = 0;

  void Add(const TransferStrength& other) {
    right += other.right;
    total += other.total;
  }
  /// Equation 7.4: 100 * right / total; undefined without pieces.
  Measure Percent() const {
    return Ratio(100 * static_cast<double>(right), static_cast<double>(total));
  }
};

/// Of the outputs of C, one a piece of motion.
TransferStrength CountTransferred(std::span<const float> strengths);

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_TRANSFER_H_
