// Poses as OpenPose writes them: a JSON file a frame with BODY_25, 70 face points and 21 points a
// hand, in pixels.  Points that the motion has not are 0, 0 with confidence 0.
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "models/motion/joints.h"
#include "models/motion/select.h"
#include "models/outputs/new_folder.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

using motion::kBody25;
using motion::kBody25Points;
using motion::kBodyJoints;
using motion::kFacePoints;
using motion::kHandPoints;
using motion::PoseSource;
using motion::Stance;

constexpr const char* kEnding = "_keypoints.json";
constexpr int kOpenposeDigits = 3;

struct Pixel {
  float x = 0, y = 0;
  bool there = false;
};

// One field of the JSON: three numbers a point; nothing when there is no point.
void AppendField(const char* name, std::span<const Pixel> points, bool any, std::string* text) {
  *text += ",\"" + std::string(name) + "\":[";
  for (std::size_t i = 0; any && i < points.size(); ++i) {
    if (i > 0) *text += ',';
    if (!points[i].there) {
      *text += "0,0,0";
      continue;
    }
    const std::size_t begin = text->size();
    AppendFixed(text, points[i].x, kOpenposeDigits);
    *text += ',';
    AppendFixed(text, points[i].y, kOpenposeDigits);
    // Readers take the corner of the picture for a point that was not found.
    if (std::string_view(*text).substr(begin) == "0.000,0.000") text->back() = '1';
    *text += ",1";
  }
  *text += ']';
}

// Frame by frame into the points of OpenPose.
class Writer {
 public:
  Writer(const Motion& motion, const FormatOptions& options)
      : motion_(motion), stances_(options.stances) {
    if (stances_.empty()) stances_ = {kCentreStance};
  }

  Status Prepare() {
    const PoseSource source = motion_.normalised ? PoseSource::kNormalize : PoseSource::kData;
    motion::PoseLayout layout;
    layout.source = source;
    layout.joints = SourcesOf(*motion_.body);
    Result<std::vector<float>> pixels = motion::PosePixels(motion_.body->values, layout, stances_);
    if (!pixels.ok()) return pixels.status().In("body");
    body_ = *std::move(pixels);
    if (!motion_.face) return Status();
    for (const Point& point : motion_.face->points) {
      if (point.source >= 0 && point.source < kFacePoints) continue;
      return Status(Code::kBadInput, "face: landmark " + std::to_string(point.source) +
                                         ", expected 0 to " + std::to_string(kFacePoints - 1));
    }
    pixels = motion::FacePixels(motion_.face->values, std::ssize(motion_.face->points), source,
                                stances_);
    if (!pixels.ok()) return pixels.status().In("face");
    face_ = *std::move(pixels);
    return Status();
  }

  std::string Frame(std::int64_t frame) const {
    std::array<Pixel, kBody25Points> body;
    std::array<Pixel, 2 * kHandPoints> hands;  // the left one first, as in PATS
    bool left = false, right = false;
    const Stance& stance = stances_[stances_.size() == 1 ? 0 : static_cast<std::size_t>(frame)];
    body[kBody25[motion::kNeck]] = {stance.neck_x, stance.neck_y, true};  // also without a column
    for (std::size_t i = 0; i < motion_.body->points.size(); ++i) {
      const auto joint = static_cast<std::size_t>(motion_.body->points[i].source);
      const Pixel pixel = At(body_, frame, i, motion_.body->points.size());
      if (joint < kBodyJoints) {
        body[kBody25[joint]] = pixel;
        continue;
      }
      hands[joint - kBodyJoints] = pixel;
      (joint < motion::kRHandRoot ? left : right) = true;
    }
    std::array<Pixel, kFacePoints> face;
    for (std::size_t i = 0; motion_.face && i < motion_.face->points.size(); ++i)
      face[static_cast<std::size_t>(motion_.face->points[i].source)] =
          At(face_, frame, i, motion_.face->points.size());
    std::string text = "{\"version\":1.3,\"people\":[{\"person_id\":[-1]";
    const std::span<const Pixel> both(hands);
    AppendField("pose_keypoints_2d", body, true, &text);
    AppendField("face_keypoints_2d", face, motion_.face.has_value(), &text);
    AppendField("hand_left_keypoints_2d", both.first(kHandPoints), left, &text);
    AppendField("hand_right_keypoints_2d", both.last(kHandPoints), right, &text);
    for (const char* name : {"pose", "face", "hand_left", "hand_right"})
      text += ",\"" + std::string(name) + "_keypoints_3d\":[]";
    return text + "}]}\n";
  }

 private:
  static std::vector<std::int32_t> SourcesOf(const Figure& figure) {
    std::vector<std::int32_t> sources;
    for (const Point& point : figure.points)
      sources.push_back(point.source < 0 || point.source >= motion::kPatsJoints
                            ? -1  // PosePixels says what it expected
                            : static_cast<std::int32_t>(point.source));
    return sources;
  }

  static Pixel At(const std::vector<float>& pixels, std::int64_t frame, std::size_t point,
                  std::size_t points) {
    const std::size_t row = static_cast<std::size_t>(frame) * 2 * points;
    return {pixels[row + point], pixels[row + points + point], true};
  }

  const Motion& motion_;
  std::vector<Stance> stances_;
  std::vector<float> body_, face_;  // pixels, laid out as the figures are
};

}  // namespace

Status WriteOpenPose(const Motion& motion, const std::string& path, const FormatOptions& options) {
  Writer writer(motion, options);
  GESTUS_RETURN_IF_ERROR(writer.Prepare());
  Result<NewFolder> folder = NewFolder::Create(path, kEnding);
  if (!folder.ok()) return folder.status();
  const std::string name = ClipName(path, options);
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    const std::string digits = std::to_string(t);
    const std::string file =
        name + "_" + std::string(12 - std::min<std::size_t>(12, digits.size()), '0') + digits;
    GESTUS_RETURN_IF_ERROR(folder->Write(file + kEnding, writer.Frame(t)));
  }
  return folder->Commit();
}

}  // namespace gestus::outputs
