#include "models/outputs/face_curves.h"

#include <algorithm>
#include <span>
#include <string_view>

namespace gestus::outputs {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// 1 of "AU01" and "AU01_r"; -1 for other names.
int UnitOf(std::string_view name) {
  if (name.ends_with("_r")) name.remove_suffix(2);
  if (name.size() != 4 || !name.starts_with("AU") || !IsDigit(name[2]) || !IsDigit(name[3]))
    return -1;
  return 10 * (name[2] - '0') + (name[3] - '0');
}

// 0 of "Rx" and "pose_Rx"; -1 for other names.
int AxisOf(std::string_view name) {
  if (name.starts_with("pose_")) name.remove_prefix(5);
  if (name.size() != 2 || name[0] != 'R' || name[1] < 'x' || name[1] > 'z') return -1;
  return name[1] - 'x';
}

bool Any(std::span<const std::optional<std::size_t>> columns) {
  return std::any_of(columns.begin(), columns.end(), [](const auto& c) { return c.has_value(); });
}

}  // namespace

FaceCurves::FaceCurves(const Motion& motion) {
  if (!motion.curves) return;
  curves_ = &*motion.curves;
  for (std::size_t i = 0; i < curves_->curves.size(); ++i) {
    const std::string& name = curves_->curves[i].name;
    const int unit = UnitOf(name), axis = AxisOf(name);
    if (unit >= 0 && !units_[static_cast<std::size_t>(unit)])
      units_[static_cast<std::size_t>(unit)] = i;
    if (axis >= 0 && !angles_[static_cast<std::size_t>(axis)])
      angles_[static_cast<std::size_t>(axis)] = i;
  }
}

bool FaceCurves::HasUnits() const { return Any(units_); }

bool FaceCurves::HasHead() const { return Any(angles_); }

// Camera axes (x right, y down, z away) are the model's (x its left, y up, z to the viewer) turned
// by half a turn about x.
Quaternion HeadRotation(const FaceCurves& face, std::int64_t frame) {
  return Product(AboutAxis(0, face.Angle(frame, 0)),
                 Product(AboutAxis(1, -face.Angle(frame, 1)), AboutAxis(2, -face.Angle(frame, 2))));
}

double FaceCurves::Weight(std::int64_t frame, int unit) const {
  return std::clamp(Unit(frame, unit) / 5.0, 0.0, 1.0);
}

}  // namespace gestus::outputs
