// MPEG-4 body animation parameters of Greta: the head, made of its angles or of where the nose is,
// and the arms, whose depth is the guess of the lifted BVH.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "models/motion/resample.h"
#include "models/outputs/arm.h"
#include "models/outputs/face_curves.h"
#include "models/outputs/greta_file.h"
#include "models/outputs/lift.h"

namespace gestus::outputs {
namespace {

constexpr int kBaps = 295;
constexpr double kUnit = 1e5;  // BAPs are radians x 100000

// Of vertebra C3, and of the left arm; those of the right one are the next ones.  A joint of
// Greta's is turned by about z (roll, abduct) * about y (torsion, twisting) * about x (tilt,
// flexion).
constexpr std::size_t kNeckRoll = 57, kNeckTorsion = 58, kNeckTilt = 59;
constexpr std::size_t kShoulderFlexion = 32, kShoulderAbduct = 34, kShoulderTwisting = 36;
constexpr std::size_t kElbowFlexion = 38;

// The bones that are looked at: the left arm's, kRight further on the right one's, and from neck to
// nose; and PATS' points that they lead to.
enum Limb : std::size_t { kUpperArm, kForearm, kNeck = 4, kLimbs };
constexpr std::size_t kRight = 2;
constexpr std::array<std::int64_t, kLimbs> kEnds = {5, 6, 2, 3, 7};

/// Where limbs point, at Greta's rate.
struct Limbs {
  std::array<bool, kLimbs> has = {};
  motion::Track spans;  // (frames, x of all limbs, y, z), cm

  Vector3 At(std::int64_t frame, std::size_t limb) const {
    const auto i = static_cast<std::int64_t>(limb);
    return {spans.value(frame, 0, i), spans.value(frame, 1, i), spans.value(frame, 2, i)};
  }
};

Result<Limbs> LimbsOf(const Motion& motion) {
  Limbs limbs;
  const Result<Skeleton> skeleton = MakeSkeleton(motion, {}, LiftedQuantile);
  if (!skeleton.ok()) return skeleton.status();
  std::vector<Vector3> spans = SpansOf(*skeleton, motion);
  Lift(*skeleton, motion.frames, &spans);
  motion::Track track(std::vector<std::string>(kLimbs), 3, motion.frames, motion.frame_rate);
  const std::size_t bones = skeleton->bones.size();
  for (std::size_t limb = 0; limb < kLimbs; ++limb) {
    for (std::size_t bone = 0; bone < bones && !limbs.has[limb]; ++bone) {
      if (!skeleton->IsBone(static_cast<int>(bone)) || skeleton->bones[bone].source != kEnds[limb])
        continue;
      limbs.has[limb] = true;
      for (std::int64_t t = 0; t < motion.frames; ++t) {
        const Vector3& span = spans[static_cast<std::size_t>(t) * bones + bone];
        const auto i = static_cast<std::int64_t>(limb);
        track.value(t, 0, i) = static_cast<float>(span.x);
        track.value(t, 1, i) = static_cast<float>(span.y);
        track.value(t, 2, i) = static_cast<float>(span.z);
      }
    }
  }
  Result<motion::Track> resampled = motion::Resample(track, kGretaRate);
  if (!resampled.ok()) return resampled.status();
  limbs.spans = *std::move(resampled);
  return limbs;
}

std::vector<bool> UsedBy(bool has_head, const Limbs& limbs) {
  std::vector<bool> used(kBaps + 1);
  used[kNeckRoll] = has_head || limbs.has[kNeck];
  used[kNeckTorsion] = used[kNeckTilt] = has_head;
  for (const std::size_t side : {0U, 1U}) {
    const bool upper = limbs.has[kUpperArm + side * kRight];
    for (const std::size_t bap : {kShoulderFlexion, kShoulderAbduct, kShoulderTwisting})
      used[bap + side] = upper;
    used[kElbowFlexion + side] = upper && limbs.has[kForearm + side * kRight];
  }
  return used;
}

void SetHead(const Quaternion& turn, std::vector<double>* values) {
  const auto [tilt, torsion, roll] =
      AnglesXyz(Turned(turn, {1, 0, 0}), Turned(turn, {0, 1, 0}), Turned(turn, {0, 0, 1}));
  (*values)[kNeckTilt] = tilt * kUnit;
  (*values)[kNeckTorsion] = torsion * kUnit;
  (*values)[kNeckRoll] = roll * kUnit;
}

void SetArm(const Arm& arm, std::size_t side, std::vector<double>* values) {
  const auto [flexion, twisting, abduct] = arm.shoulder();
  (*values)[kShoulderFlexion + side] = flexion * kUnit;
  (*values)[kShoulderTwisting + side] = twisting * kUnit;
  (*values)[kShoulderAbduct + side] = abduct * kUnit;
  (*values)[kElbowFlexion + side] = arm.elbow() * kUnit;
}

}  // namespace

Status WriteBap(const Motion& motion, const std::string& path, const FormatOptions& options) {
  const bool has_head = FaceCurves(motion).HasHead();
  Limbs limbs;
  if (motion.body) {
    Result<Limbs> found = LimbsOf(motion);
    if (!found.ok()) return found.status();
    limbs = *std::move(found);
  }
  Motion curves;
  if (has_head) {
    Result<Motion> resampled = CurvesAtGretasRate(motion);
    if (!resampled.ok()) return resampled.status();
    curves = *std::move(resampled);
  }
  const FaceCurves face(curves);
  const std::int64_t frames = has_head ? curves.frames : limbs.spans.frames;
  Result<GretaFile> file =
      GretaFile::Create(path, ClipName(path, options), frames, UsedBy(has_head, limbs));
  if (!file.ok()) return file.status();
  std::array<Arm, 2> arms;
  for (std::int64_t t = 0; t < frames; ++t) {
    std::vector<double> values(kBaps + 1);
    if (has_head) {
      SetHead(HeadRotation(face, t), &values);
    } else if (limbs.has[kNeck]) {
      const Vector3 neck = limbs.At(t, kNeck);
      values[kNeckRoll] = std::atan2(-neck.x, neck.y) * kUnit;
    }
    for (const std::size_t side : {0U, 1U}) {
      if (!limbs.has[kUpperArm + side * kRight]) continue;
      arms[side].Next(limbs.At(t, kUpperArm + side * kRight),
                      limbs.At(t, kForearm + side * kRight));
      SetArm(arms[side], side, &values);
    }
    GESTUS_RETURN_IF_ERROR(file->Add(t, values));
  }
  return file->Commit();
}

}  // namespace gestus::outputs
