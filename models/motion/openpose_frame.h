// One frame of OpenPose: who is in it, and which of them is ours.  A private header of the reader.
#ifndef GESTUS_MODELS_MOTION_OPENPOSE_FRAME_H_
#define GESTUS_MODELS_MOTION_OPENPOSE_FRAME_H_

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/status.h"
#include "models/motion/joints.h"

namespace gestus::motion {

/// Pixels, y down; confidence 0 where nothing was found.
struct Point {
  float x = 0, y = 0, confidence = 0;
};

struct Person {
  std::array<Point, kPatsJoints> body;
  std::array<Point, kFacePoints> face;
};

struct OpenPoseFrame {
  std::vector<Person> people;    ///< those with a body
  std::int64_t null_points = 0;  ///< points that were null instead of numbers
};

/// Reads the text of one file.  Errors name the field.
Result<OpenPoseFrame> ParseOpenPose(std::string_view text);

/// Follows one person through the frames: first the one whose body was found with the highest mean
/// confidence, then whoever is nearest to where that one was last.  Nobody is taken who is further
/// away than half the figure's size for each frame since then.
class PersonChooser {
 public:
  /// Null when there is nobody, or nobody near enough; to be called for every frame in order.
  const Person* Choose(const std::vector<Person>& people);

 private:
  Person last_;
  bool found_ = false;
  std::int64_t frames_since_ = 0;
};

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_OPENPOSE_FRAME_H_
