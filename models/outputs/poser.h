// From where bones point to rotations, frame after frame.  A private header of the writers.
#ifndef GESTUS_MODELS_OUTPUTS_POSER_H_
#define GESTUS_MODELS_OUTPUTS_POSER_H_

#include <array>
#include <vector>

#include "models/outputs/rotations.h"
#include "models/outputs/skeleton.h"

namespace gestus::outputs {

using Angles = std::array<double, 3>;  ///< about z, x, y; rad

/// Keeps what the last frame had, so that angles have no jumps by full turns.
class Poser {
 public:
  /// In the plane all rotations are about z, `lifted` the shortest ones from the rest pose.
  Poser(const Skeleton& skeleton, bool lifted);

  /// Of the next frame, whose `spans` are one a bone: every bone's rotation from the bone before
  /// it. A bone without length stays as it was.
  const std::vector<Angles>& Next(const Vector3* spans);

  /// Of the frame that Next() saw last: every bone's rotation from the rest pose.
  const std::vector<Quaternion>& world() const { return world_; }

 private:
  const Skeleton& skeleton_;
  bool lifted_;
  std::vector<Quaternion> world_;
  std::vector<double> turns_;  // the same in the plane, about z
  std::vector<Angles> angles_;
};

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_POSER_H_
