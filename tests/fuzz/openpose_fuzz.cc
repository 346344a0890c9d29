// OpenPose's JSON: one frame as a clip, and frames in a row, which zero bytes separate.
#include "models/motion/openpose.h"
#include "models/motion/openpose_frame.h"
#include "models/motion/select.h"
#include "tests/fuzz/motion_checks.h"

namespace gestus::fuzz {
namespace {

void Follow(std::string_view frames) {
  motion::PersonChooser chooser;
  for (int n = 0; n < 8; ++n) {
    const std::size_t end = frames.find('\0');
    const auto frame = motion::ParseOpenPose(frames.substr(0, end));
    if (frame.ok()) {
      const motion::Person* chosen = chooser.Choose(frame->people);
      Require(chosen == nullptr || (chosen >= frame->people.data() &&
                                    chosen < frame->people.data() + frame->people.size()),
              "the chosen one is there");
    }
    if (end == std::string_view::npos) return;
    frames.remove_prefix(end + 1);
  }
}

void ReadClip(const std::string& path) {
  auto clip = motion::ReadOpenPose(path);
  if (!clip.ok()) return RequireSentence(clip.status(), path);
  Prepare(&clip->body, motion::CleanOrder::kFillFirst);
  if (clip->face.frames > 0) Prepare(&clip->face, motion::CleanOrder::kFillFirst);
  const auto stances = motion::FindStances(clip->body);
  if (!stances.ok()) return;
  const motion::PoseLayout layout = {.joints = {0, 1}};
  const auto pose = motion::PoseColumns(clip->body, layout, stances->frames);
  Require(pose.ok(), "joints that stances need were seen");
  for (const float v : *pose) Require(std::isfinite(v), "poses are finite");
  Require(motion::PosePixels(*pose, layout, stances->frames).ok(), "poses can be drawn");
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static gestus::fuzz::MemoryFile file;
  gestus::fuzz::Follow({reinterpret_cast<const char*>(data), size});
  gestus::fuzz::ReadClip(file.Write(data, size));
  return 0;
}
