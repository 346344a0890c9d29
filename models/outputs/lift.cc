#include "models/outputs/lift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "models/outputs/joints.h"

namespace gestus::outputs {
namespace {

bool IsUpper(std::int64_t source) { return source == kRElbow || source == kLElbow; }
bool IsFore(std::int64_t source) { return source == kRWrist || source == kLWrist; }

// Costs of an arm's direction, for unit vectors: an upper arm or a forearm that points straight
// away from the viewer, an elbow bent beyond 150 degrees, and a change from one frame to the next,
// squared.
constexpr double kUpperBack = 2, kForeBack = 3, kFolded = 4, kChange = 4;
constexpr double kMostFolded = -0.8660254037844386;  // cos 150 degrees

constexpr std::size_t kStates = 4;  // bit 0: the upper arm points away; bit 1: the forearm

struct Arm {
  Vector3 upper, fore;  // units; without length where the figure has no such bone
};

Vector3 Scaled(const Vector3& v, double factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}

double Apart(const Vector3& a, const Vector3& b) {
  const Vector3 d = {a.x - b.x, a.y - b.y, a.z - b.z};
  return Dot(d, d);
}

double CostOf(const Arm& arm) {
  return kUpperBack * std::max(0.0, -arm.upper.z) + kForeBack * std::max(0.0, -arm.fore.z) +
         kFolded * std::max(0.0, kMostFolded - Dot(arm.upper, arm.fore));
}

// One arm through the clip.
class Lifter {
 public:
  Lifter(const Skeleton& skeleton, int upper, int fore, std::int64_t frames,
         std::vector<Vector3>* spans)
      : skeleton_(skeleton), upper_(upper), fore_(fore), frames_(frames), spans_(*spans) {}

  void Run() {
    std::vector<std::array<std::uint8_t, kStates>> came_from(static_cast<std::size_t>(frames_));
    std::array<double, kStates> cost = {};
    for (std::int64_t t = 0; t < frames_; ++t) {
      std::array<double, kStates> next;
      for (std::size_t state = 0; state < kStates; ++state) {
        const Arm arm = At(t, state);
        std::size_t best = 0;
        double least = t == 0 ? 0 : HUGE_VAL;
        for (std::size_t last = 0; t > 0 && last < kStates; ++last) {
          const Arm before = At(t - 1, last);
          const double sum = cost[last] + kChange * (Apart(arm.upper, before.upper) +
                                                     Apart(arm.fore, before.fore));
          if (sum < least) least = sum, best = last;
        }
        next[state] = least + CostOf(arm);
        came_from[static_cast<std::size_t>(t)][state] = static_cast<std::uint8_t>(best);
      }
      cost = next;
    }
    auto state =
        static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    std::vector<std::size_t> states(came_from.size());
    for (std::size_t t = states.size(); t-- > 0; state = came_from[t][state]) states[t] = state;
    for (std::int64_t t = 0; t < frames_; ++t) {
      Give(t, upper_, states[static_cast<std::size_t>(t)] & 1U);
      Give(t, fore_, states[static_cast<std::size_t>(t)] & 2U);
    }
  }

 private:
  Vector3& SpanAt(std::int64_t t, int bone) const {
    return spans_[static_cast<std::size_t>(t * std::ssize(skeleton_.bones) + bone)];
  }

  double Depth(const Vector3& span, int bone) const {
    const double length = skeleton_.bones[static_cast<std::size_t>(bone)].length;
    return std::sqrt(std::max(0.0, length * length - span.x * span.x - span.y * span.y));
  }

  Vector3 Direction(std::int64_t t, int bone, bool away) const {
    if (bone == kNone) return {};
    Vector3 span = SpanAt(t, bone);
    span.z = (away ? -1 : 1) * Depth(span, bone);
    const double length = Length(span);
    return length > 0 ? Scaled(span, 1 / length) : Vector3{};
  }

  Arm At(std::int64_t t, std::size_t state) const {
    return {Direction(t, upper_, state & 1U), Direction(t, fore_, state & 2U)};
  }

  void Give(std::int64_t t, int bone, bool away) const {
    if (bone == kNone) return;
    Vector3& span = SpanAt(t, bone);
    span.z = (away ? -1 : 1) * Depth(span, bone);
  }

  const Skeleton& skeleton_;
  int upper_, fore_;
  std::int64_t frames_;
  std::vector<Vector3>& spans_;
};

}  // namespace

double LiftedQuantile(const Bone& bone) {
  return IsUpper(bone.source) || IsFore(bone.source) ? 0.95 : 0.5;
}

void Lift(const Skeleton& skeleton, std::int64_t frames, std::vector<Vector3>* spans) {
  for (const auto& [elbow, wrist] : {std::pair(kRElbow, kRWrist), std::pair(kLElbow, kLWrist)}) {
    int upper = kNone, fore = kNone;
    for (int i = 0; i < std::ssize(skeleton.bones); ++i) {
      if (!skeleton.IsBone(i)) continue;
      const std::int64_t source = skeleton.bones[static_cast<std::size_t>(i)].source;
      if (source == elbow && upper == kNone) upper = i;
      if (source == wrist && fore == kNone) fore = i;
    }
    if (upper != kNone || fore != kNone) Lifter(skeleton, upper, fore, frames, spans).Run();
  }
}

}  // namespace gestus::outputs
