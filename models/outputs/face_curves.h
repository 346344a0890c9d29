// Action units and head angles by what they are, whatever their columns are called.  A private
// header of the writers.
#ifndef GESTUS_MODELS_OUTPUTS_FACE_CURVES_H_
#define GESTUS_MODELS_OUTPUTS_FACE_CURVES_H_

#include <array>
#include <cstdint>
#include <optional>

#include "models/outputs/motion.h"
#include "models/outputs/rotations.h"

namespace gestus::outputs {

/// Looks into a motion that must outlive it.  Curves are known by OpenFace's names: "AU01" or
/// "AU01_r", "Rx" or "pose_Rx"; of two of one name the first counts.
class FaceCurves {
 public:
  explicit FaceCurves(const Motion& motion);

  bool HasUnits() const;
  bool HasHead() const;
  bool HasUnit(int unit) const { return units_[static_cast<std::size_t>(unit)].has_value(); }
  /// Intensity of action unit 0 to 99 as it stands in the motion; 0 for one that it has not.
  float Unit(std::int64_t frame, int unit) const {
    return Value(frame, units_[static_cast<std::size_t>(unit)]);
  }
  /// The same as a weight: intensity / 5, within 0 to 1.
  double Weight(std::int64_t frame, int unit) const;
  /// Rotation about the camera's axis 0 (x, right), 1 (y, down) or 2 (z, away), in rad; 0 for one
  /// that the motion has not.
  float Angle(std::int64_t frame, int axis) const {
    return Value(frame, angles_[static_cast<std::size_t>(axis)]);
  }

 private:
  float Value(std::int64_t frame, const std::optional<std::size_t>& column) const {
    return column ? curves_->at(frame, *column) : 0.0f;
  }

  const Curves* curves_ = nullptr;
  std::array<std::optional<std::size_t>, 100> units_;
  std::array<std::optional<std::size_t>, 3> angles_;
};

/// How the head turns, in the face's own axes: x its left, y up, z to the viewer.
Quaternion HeadRotation(const FaceCurves& face, std::int64_t frame);

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_FACE_CURVES_H_
