#include "models/outputs/formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "models/io/text.h"
#include "models/outputs/blendshapes.h"
#include "models/outputs/face_curves.h"
#include "models/outputs/joints.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

// In the order of the enumeration.
constexpr std::array<const char*, 11> kNames = {"openpose", "openface", "openface2", "csv",
                                                "bvh",      "bvh3d",    "arkit",     "vrm",
                                                "vrma",     "fap",      "bap"};

// Larger values are no motion, and would overflow on the way to a file.
constexpr float kMost = 1e9f;

Status Bad(const std::string& what) { return Status(Code::kInvalidArgument, what); }

Status CheckValues(const std::string& what, const std::vector<float>& values, std::int64_t frames,
                   std::int64_t columns) {
  if (std::ssize(values) != frames * columns)
    return Bad(what + ": " + Count(values.size(), "value") + ", expected " +
               std::to_string(frames) + " x " + std::to_string(columns));
  const auto bad =
      std::find_if(values.begin(), values.end(), [](float x) { return !(std::fabs(x) <= kMost); });
  if (bad == values.end()) return Status();
  return Status(Code::kNonFinite, what + ": no number within 1e9 of 0 in frame " +
                                      std::to_string((bad - values.begin()) / columns) +
                                      ", expected such numbers only");
}

Status CheckMotion(const Motion& motion) {
  GESTUS_RETURN_IF_ERROR(motion::CheckFrameRate(motion.frame_rate, "the motion"));
  if (motion.frames < 1) return Bad("a motion without frames, expected one at least");
  if (!motion.body && !motion.face && !motion.curves)
    return Bad("a motion of nothing, expected a body, a face or curves");
  for (const auto* figure : {&motion.body, &motion.face}) {
    if (!*figure) continue;
    const std::string what = figure == &motion.body ? "body" : "face";
    if ((*figure)->points.empty()) return Bad(what + ": no points, expected one at least");
    GESTUS_RETURN_IF_ERROR(
        CheckValues(what, (*figure)->values, motion.frames, (*figure)->columns()));
  }
  if (!motion.curves) return Status();
  return CheckValues("curves", motion.curves->values, motion.frames,
                     std::ssize(motion.curves->curves));
}

Status CheckStances(const Motion& motion, const FormatOptions& options) {
  const auto n = std::ssize(options.stances);
  if (n > 1 && n != motion.frames)
    return Bad(Count(options.stances.size(), "stance") + " for " +
               Count(static_cast<std::uint64_t>(motion.frames), "frame") +
               ", expected one or as many");
  for (const motion::Stance& s : options.stances) {
    if (std::fabs(s.neck_x) <= kMost && std::fabs(s.neck_y) <= kMost && s.shoulder > 1 / kMost &&
        s.shoulder <= kMost)
      continue;
    return Bad("a stance that is no place in a picture, expected a neck and a length above 0");
  }
  return Status();
}

bool HasPoint(const Motion& motion, std::initializer_list<std::int64_t> sources) {
  if (!motion.body) return false;
  return std::any_of(motion.body->points.begin(), motion.body->points.end(), [&](const Point& p) {
    return std::find(sources.begin(), sources.end(), p.source) != sources.end();
  });
}

bool HasExpression(const FaceCurves& face) {
  return std::any_of(kBlendshapes.begin(), kBlendshapes.end(), [&](const Blendshape& shape) {
    return shape.unit != 0 && face.HasUnit(shape.unit);
  });
}

/// What `motion` lacks for `format`; empty: nothing.
std::string LackOf(const Motion& motion, Format format) {
  const FaceCurves face(motion);
  const bool has_face = face.HasUnits() || face.HasHead();
  // Elbows and the nose; a forearm alone turns a bone of VRM, but no joint of Greta's.
  const bool has_upper = HasPoint(motion, {kLElbow, kRElbow, kNose});
  switch (format) {
    case Format::kCsv:
      return "";
    case Format::kOpenPose:
    case Format::kBvh:
    case Format::kBvh3d:
      return motion.body ? "" : "body";
    case Format::kOpenFace:
    case Format::kOpenFace2:
    case Format::kArkit:
    case Format::kVrm:
      return has_face ? "" : "action units and head angles";
    case Format::kVrma:
      if (has_upper || face.HasHead() || HasExpression(face) ||
          HasPoint(motion, {kLWrist, kRWrist}))
        return "";
      return motion.body ? "arms and no nose" : "body, action units or head angles";
    case Format::kFap:
      return HasFap(face) ? "" : "action units of brows, lids or cheeks";
    case Format::kBap:
      return face.HasHead() || has_upper ? "" : "head angles, no arms and no nose";
  }
  return "";
}

Status Write(const Motion& motion, Format format, const std::string& path,
             const FormatOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckMotion(motion));
  GESTUS_RETURN_IF_ERROR(Suits(motion, format));
  GESTUS_RETURN_IF_ERROR(CheckStances(motion, options));
  switch (format) {
    case Format::kOpenPose:
      return WriteOpenPose(motion, path, options);
    case Format::kOpenFace:
      return WriteOpenFace(motion, path, options, false);
    case Format::kOpenFace2:
      return WriteOpenFace(motion, path, options, true);
    case Format::kCsv:
      return WriteCsv(motion, path);
    case Format::kBvh:
      return WriteBvh(motion, path, options, false);
    case Format::kBvh3d:
      return WriteBvh(motion, path, options, true);
    case Format::kArkit:
      return WriteArkit(motion, path);
    case Format::kVrm:
      return WriteVrm(motion, path);
    case Format::kVrma:
      return WriteVrma(motion, path);
    case Format::kFap:
      return WriteFap(motion, path, options);
    case Format::kBap:
      return WriteBap(motion, path, options);
  }
  return Bad("no such format");
}

}  // namespace

std::vector<std::string> FormatNames() { return {kNames.begin(), kNames.end()}; }

std::string NameOf(Format format) { return kNames[static_cast<std::size_t>(format)]; }

Result<Format> FormatOf(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found != kNames.end()) return static_cast<Format>(found - kNames.begin());
  std::string all;
  for (const char* known : kNames) all += (all.empty() ? "" : ", ") + std::string(known);
  return Bad("format \"" + OneLine(name, 40) + "\" is unknown, expected one of " + all);
}

Status Suits(const Motion& motion, Format format) {
  const std::string lack = LackOf(motion, format);
  if (lack.empty()) return Status();
  return Bad("the motion has no " + lack + ", which the format " + NameOf(format) + " needs");
}

Status WriteMotion(const Motion& motion, Format format, const std::string& path,
                   const FormatOptions& options) {
  return Write(motion, format, path, options).In(path);
}

}  // namespace gestus::outputs
