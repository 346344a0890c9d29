// Behaviour expressivity (thesis 6.7.1): how fast, how abruptly and how widely somebody moves.
#ifndef GESTUS_MODELS_METRICS_BEHAVIOUR_H_
#define GESTUS_MODELS_METRICS_BEHAVIOUR_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "models/metrics/measure.h"
#include "models/outputs/motion.h"

namespace gestus::metrics {

constexpr std::size_t kBehaviours = 7;

struct BehaviourName {
  const char* id;     ///< "wrist_velocity"
  const char* label;  ///< "wrist velocity"
  const char* unit;   ///< "units/s"; a unit is that of the joints
};
/// In the order of Behaviour: of all joints, of the wrists, and the box.
constexpr std::array<BehaviourName, kBehaviours> kBehaviourNames = {
    {{"velocity", "velocity", "units/s"},
     {"acceleration", "acceleration", "units/s^2"},
     {"jerk", "jerk", "units/s^3"},
     {"wrist_velocity", "wrist velocity", "units/s"},
     {"wrist_acceleration", "wrist acceleration", "units/s^2"},
     {"wrist_jerk", "wrist jerk", "units/s^3"},
     {"box_perimeter", "box perimeter", "units"}}};

using Behaviour = std::array<Measure, kBehaviours>;

/// What the means are made of: kept apart, those of several sequences can be added.
struct BehaviourSums {
  std::array<double, kBehaviours> sums{};
  std::array<std::int64_t, kBehaviours> counts{};

  void Add(const BehaviourSums& other);
  /// Undefined where nothing was counted: velocity of fewer than 2 frames, acceleration of fewer
  /// than 3, jerk of fewer than 4, the box without a frame, anything of no joints.
  Behaviour Mean() const;
};

/// Of the joints of `body` with these sources (without the neck, see SharedSources), over the first
/// `frames` frames at `rate` frames per second.
///
/// Velocity is the mean over joints and frames of |p(t+1) - p(t)| * rate, with the Euclidean norm
/// over x and y; acceleration that of the second difference times rate^2, jerk that of the third
/// times rate^3.  Wrists are PATS' joints 3 and 6.  The box is the smallest upright one around the
/// joints and, where the body has one, the neck, which stands at 0; its perimeter 2 (w + h) is
/// averaged over frames.
BehaviourSums SumBehaviour(const outputs::Figure& body, std::int64_t frames, double rate,
                           std::span<const std::int64_t> sources);

/// Mean speed of the wrists between one frame and the next, frames - 1 values; empty without
/// wrists.
std::vector<double> WristSpeed(const outputs::Figure& body, std::int64_t frames, double rate);

/// Equation 6.9: Dist.(x, Target) = |behaviour of x - behaviour of the target|, and Dist_avg, its
/// share of Dist.(Source, Target) + Dist.(model, Target) in percent, with x the source and the
/// model.  The two shares add up to 100.
struct StyleDistance {
  Measure source, prediction;                  ///< Dist.
  Measure source_percent, prediction_percent;  ///< Dist_avg; undefined where both distances are 0
};
StyleDistance DistanceToTarget(const Measure& source, const Measure& prediction,
                               const Measure& target);

}  // namespace gestus::metrics

#endif  // GESTUS_MODELS_METRICS_BEHAVIOUR_H_
