// OpenFace's CSV as the thesis' author wrote it: the columns that Greta reads, those that no
// network makes as 0.
#include <array>
#include <string>

#include "models/outputs/face_curves.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

constexpr const char* kKeys = "frame,face_id,timestamp,confidence,success";
constexpr const char* kGazeAndPlace =
    "gaze_0_x,gaze_0_y,gaze_0_z,gaze_1_x,gaze_1_y,gaze_1_z,gaze_angle_x,gaze_angle_y,"
    "pose_Tx,pose_Ty,pose_Tz";
constexpr int kZeros = 11;  // columns of kGazeAndPlace
constexpr std::array<int, 17> kUnits = {1,  2,  4,  5,  6,  7,  9,  10, 12,
                                        14, 15, 17, 20, 23, 25, 26, 45};
// Plain digits: Greta's reader knows no exponents.
constexpr int kOpenfaceDigits = 6;

std::string Header(bool with_keys) {
  std::string line = with_keys ? kKeys : "timestamp";
  line += "," + std::string(kGazeAndPlace) + ",pose_Rx,pose_Ry,pose_Rz";
  for (const int unit : kUnits) {
    line += ",AU";
    line += {static_cast<char>('0' + unit / 10), static_cast<char>('0' + unit % 10)};
    line += "_r";
  }
  return line + "\n";
}

}  // namespace

Status WriteOpenFace(const Motion& motion, const std::string& path, const FormatOptions& options,
                     bool with_keys) {
  const FaceCurves face(motion);
  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  GESTUS_RETURN_IF_ERROR(file->Add(Header(with_keys)));
  const double scale = options.halve ? 0.5 : 1.0;
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    std::string row = with_keys ? std::to_string(t + 1) + ",0," : "";
    AppendFixed(&row, static_cast<double>(t) / motion.frame_rate, kOpenfaceDigits);
    if (with_keys) row += ",1,1";
    for (int i = 0; i < kZeros; ++i) row += ",0";
    const auto add = [&](double value) {
      row += ',';
      AppendFixed(&row, value * scale, kOpenfaceDigits);
    };
    for (int axis = 0; axis < 3; ++axis) add(face.Angle(t, axis));
    for (const int unit : kUnits) add(face.Unit(t, unit));
    GESTUS_RETURN_IF_ERROR(file->Add(row + "\n"));
  }
  return file->Commit();
}

}  // namespace gestus::outputs
