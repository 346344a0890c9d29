#include "models/outputs/poser.h"

#include <cmath>

namespace gestus::outputs {

Poser::Poser(const Skeleton& skeleton, bool lifted)
    : skeleton_(skeleton),
      lifted_(lifted),
      world_(skeleton.bones.size()),
      turns_(skeleton.bones.size()),
      angles_(skeleton.bones.size()) {}

const std::vector<Angles>& Poser::Next(const Vector3* spans) {
  for (std::size_t i = 0; i < skeleton_.bones.size(); ++i) {
    const double length = Length(spans[i]);
    if (!skeleton_.IsBone(static_cast<int>(i)) || !(length > 1e-9)) continue;
    const Vector3& v = spans[i];
    const Vector3& rest = skeleton_.bones[i].rest;
    world_[i] = Between(rest, {v.x / length, v.y / length, v.z / length});
    turns_[i] = Nearest(std::atan2(v.y, v.x) - std::atan2(rest.y, rest.x), turns_[i]);
  }
  for (std::size_t i = 0; i < skeleton_.bones.size(); ++i) {
    if (!skeleton_.IsBone(static_cast<int>(i))) continue;
    const int before = skeleton_.bones[i].before;
    const auto b = static_cast<std::size_t>(before);
    if (lifted_) {
      const Quaternion local = before == kNone ? world_[i] : Product(Inverse(world_[b]), world_[i]);
      angles_[i] = AnglesZxy(local, angles_[i]);
    } else {
      angles_[i] = {before == kNone ? turns_[i] : turns_[i] - turns_[b], 0, 0};
    }
  }
  return angles_;
}

}  // namespace gestus::outputs
