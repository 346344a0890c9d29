// Live Link Face's CSV: a timecode, ARKit's 52 blendshapes and the rotations of head and eyes.
#include <cmath>
#include <string>

#include "models/outputs/blendshapes.h"
#include "models/outputs/face_curves.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

constexpr int kArkitDigits = 6;
// After the blendshapes: head, left eye and right eye, in Live Link Face's order of angles.
constexpr const char* kRotations =
    ",HeadYaw,HeadPitch,HeadRoll,LeftEyeYaw,LeftEyePitch,LeftEyeRoll,RightEyeYaw,RightEyePitch,"
    "RightEyeRoll\n";
constexpr const char* kStillEyes = ",0,0,0,0,0,0\n";

std::string TwoDigits(std::int64_t value) {
  return (value < 10 ? "0" : "") + std::to_string(value);
}

// "HH:MM:SS:FF.000", `rate` frames to a second.
std::string Timecode(std::int64_t frame, std::int64_t rate) {
  const std::int64_t seconds = frame / rate;
  return TwoDigits(seconds / 3600) + ":" + TwoDigits(seconds / 60 % 60) + ":" +
         TwoDigits(seconds % 60) + ":" + TwoDigits(frame % rate) + ".000";
}

}  // namespace

Status WriteArkit(const Motion& motion, const std::string& path) {
  const FaceCurves face(motion);
  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  std::string header = "Timecode,BlendshapeCount";
  for (const Blendshape& shape : kBlendshapes) {
    std::string name = shape.name;
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    header += "," + name;
  }
  GESTUS_RETURN_IF_ERROR(file->Add(header + kRotations));
  const auto rate = static_cast<std::int64_t>(std::ceil(motion.frame_rate - 1e-6));
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    std::string row = Timecode(t, rate) + ",61";
    const auto add = [&](double value) {
      row += ',';
      AppendFixed(&row, value, kArkitDigits);
    };
    for (const Blendshape& shape : kBlendshapes)
      add(shape.unit == 0 ? 0 : face.Weight(t, shape.unit));
    add(-face.Angle(t, 1));
    add(face.Angle(t, 0));
    add(-face.Angle(t, 2));
    GESTUS_RETURN_IF_ERROR(file->Add(row + kStillEyes));
  }
  return file->Commit();
}

}  // namespace gestus::outputs
