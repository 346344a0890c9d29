// An arm as two joints of an avatar: a shoulder that turns about three axes and an elbow that is a
// hinge.  A private header of the writer of BAPs.
#ifndef GESTUS_MODELS_OUTPUTS_ARM_H_
#define GESTUS_MODELS_OUTPUTS_ARM_H_

#include <array>

#include "models/outputs/rotations.h"

namespace gestus::outputs {

/// In the rest pose the arm hangs, the inside of the elbow to the front: MPEG-4's and Greta's. Axes
/// as in BVH: x the figure's left, y up, z forwards.
class Arm {
 public:
  /// The next frame: where upper arm and forearm point, of any length.  One without length keeps
  /// its direction.  An elbow that is nearly straight tells nothing about the arm's twist, which
  /// then stays as it was.
  void Next(const Vector3& upper, const Vector3& fore);

  /// Angles about x, y, z (rad): the shoulder is turned by about z * about y * about x.
  std::array<double, 3> shoulder() const;
  /// About the turned x, rad: 0 straight, below 0 bent.
  double elbow() const { return -bend_; }

 private:
  Vector3 upper_ = {0, -1, 0};
  Vector3 front_ = {0, 0, 1};  // where the inside of the elbow faces; at right angles to upper_
  Vector3 fore_ = {0, -1, 0};
  double bend_ = 0;
};

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_ARM_H_
