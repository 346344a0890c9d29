#include "models/outputs/arm.h"

#include <cmath>

namespace gestus::outputs {
namespace {

constexpr double kStraight = 0.02;  // the sine of an elbow's bend below which it counts as straight

Vector3 Unit(const Vector3& v) {
  const double length = Length(v);
  return {v.x / length, v.y / length, v.z / length};
}

// What of `v` is at right angles to the unit vector `axis`.
Vector3 Across(const Vector3& v, const Vector3& axis) {
  const double along = Dot(v, axis);
  return {v.x - along * axis.x, v.y - along * axis.y, v.z - along * axis.z};
}

}  // namespace

void Arm::Next(const Vector3& upper, const Vector3& fore) {
  if (Length(upper) > 1e-9) {
    const Vector3 now = Unit(upper);
    front_ = Unit(Across(Turned(Between(upper_, now), front_), now));
    upper_ = now;
  }
  if (Length(fore) > 1e-9) fore_ = Unit(fore);
  const Vector3 across = Across(fore_, upper_);
  const double sine = Length(across), cosine = Dot(fore_, upper_);
  if (sine > kStraight) front_ = Unit(across);
  bend_ = sine > kStraight || cosine < 0 ? std::atan2(sine, cosine) : 0;
}

std::array<double, 3> Arm::shoulder() const {
  const Vector3 y = {-upper_.x, -upper_.y, -upper_.z};
  return AnglesXyz(Cross(y, front_), y, front_);
}

}  // namespace gestus::outputs
