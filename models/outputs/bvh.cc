// Biovision hierarchy: the skeleton in its rest pose, and three angles a joint for every frame.  y
// is up, z points to the viewer, x to the right of the picture (the figure's left); centimetres and
// degrees.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "models/outputs/lift.h"
#include "models/outputs/poser.h"
#include "models/outputs/skeleton.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

constexpr int kBvhDigits = 6;
// The end of a chain, for programs that draw bones: a share of the last bone.
constexpr double kEndShare = 0.25;

std::string Numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ' ';
    AppendFixed(&text, value, kBvhDigits);
  }
  return text;
}

void AppendHierarchy(const Skeleton& skeleton, std::string* text) {
  *text += "HIERARCHY\n";
  std::vector<int> open;  // joints whose braces are
  const auto indent = [&] { return std::string(open.size(), '\t'); };
  const auto close = [&] {
    open.pop_back();
    *text += indent() + "}\n";
  };
  for (int i = 0; i < std::ssize(skeleton.joints); ++i) {
    const Joint& joint = skeleton.joints[static_cast<std::size_t>(i)];
    while (!open.empty() && open.back() != joint.parent) close();
    *text += indent() + (i == 0 ? "ROOT " : "JOINT ") + joint.name + "\n" + indent() + "{\n";
    open.push_back(i);
    *text += indent() + "OFFSET " + Numbers({joint.offset.x, joint.offset.y, joint.offset.z}) +
             "\n" + indent() +
             (i == 0 ? "CHANNELS 6 Xposition Yposition Zposition" : "CHANNELS 3") +
             " Zrotation Xrotation Yrotation\n";
    if (!joint.ends) continue;
    *text += indent() + "End Site\n" + indent() + "{\n" + indent() + "\tOFFSET " +
             Numbers({joint.offset.x * kEndShare, joint.offset.y * kEndShare,
                      joint.offset.z * kEndShare}) +
             "\n" + indent() + "}\n";
  }
  while (!open.empty()) close();
}

// Where the neck stands: its way from where it mostly is.
class NeckPath {
 public:
  NeckPath(const Motion& motion, const Skeleton& skeleton)
      : body_(*motion.body), skeleton_(skeleton) {
    if (!Moves()) return;
    for (const bool vertical : {false, true}) {
      std::vector<float> values;
      for (std::int64_t t = 0; t < motion.frames; ++t) values.push_back(At(t, vertical));
      const auto middle = values.begin() + std::ssize(values) / 2;
      std::nth_element(values.begin(), middle, values.end());
      (vertical ? y_ : x_) = *middle;
    }
  }

  Vector3 Place(std::int64_t frame) const {
    if (!Moves()) return {};
    return {(double{At(frame, false)} - x_) * skeleton_.neck_cm,
            (y_ - double{At(frame, true)}) * skeleton_.neck_cm, 0};
  }

 private:
  bool Moves() const { return body_.neck_is_position && skeleton_.neck != kNone; }
  float At(std::int64_t frame, bool vertical) const {
    const auto neck = static_cast<std::size_t>(skeleton_.neck);
    return vertical ? body_.y(frame, neck) : body_.x(frame, neck);
  }

  const Figure& body_;
  const Skeleton& skeleton_;
  double x_ = 0, y_ = 0;
};

}  // namespace

Status WriteBvh(const Motion& motion, const std::string& path, const FormatOptions& options,
                bool lifted) {
  const LengthQuantile median = [](const Bone&) { return 0.5; };
  const Result<Skeleton> skeleton = MakeSkeleton(motion, options, lifted ? LiftedQuantile : median);
  if (!skeleton.ok()) return skeleton.status();
  std::vector<Vector3> spans = SpansOf(*skeleton, motion);
  if (lifted) Lift(*skeleton, motion.frames, &spans);

  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  std::string text;
  AppendHierarchy(*skeleton, &text);
  text += "MOTION\nFrames: " + std::to_string(motion.frames) +
          "\nFrame Time: " + Exact(1 / motion.frame_rate) + "\n";
  GESTUS_RETURN_IF_ERROR(file->Add(text));
  Poser poser(*skeleton, lifted);
  const NeckPath neck(motion, *skeleton);
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    const std::vector<Angles>& angles =
        poser.Next(&spans[static_cast<std::size_t>(t) * skeleton->bones.size()]);
    const Vector3 place = neck.Place(t);
    std::string row = Numbers({place.x, place.y, place.z});
    for (const Joint& joint : skeleton->joints) {
      for (const std::size_t axis : {0U, 1U, 2U}) {
        const double angle =
            joint.bone == kNone ? 0 : angles[static_cast<std::size_t>(joint.bone)][axis];
        row += ' ';
        AppendFixed(&row, angle * 180 / kPi, kBvhDigits);
      }
    }
    GESTUS_RETURN_IF_ERROR(file->Add(row + "\n"));
  }
  return file->Commit();
}

}  // namespace gestus::outputs
