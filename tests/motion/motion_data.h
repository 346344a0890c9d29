// Folders and files for the tests of the readers of motion.
#ifndef GESTUS_TESTS_MOTION_MOTION_DATA_H_
#define GESTUS_TESTS_MOTION_MOTION_DATA_H_

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "models/motion/openpose_frame.h"

namespace gestus::motion {

/// A new folder that goes with what is in it.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Writes a file and gives its path.
  std::string Write(const std::string& name, std::string_view content) const;

 private:
  std::string path_;
};

/// "talk_000000000012_keypoints.json"
std::string FrameName(std::int64_t number);

/// Key points of one person as OpenPose numbers them; empty ones are written as [].
struct Figure {
  std::vector<Point> pose, face, left, right;
};

/// A figure of 25 body points around (x, y): point i at (x + i, y + 2 i), with `confidence`.
Figure FigureAt(float x, float y, float confidence = 0.5f);

/// The text of a frame; `suffix` "_2d" or "".
std::string FrameText(const std::vector<Figure>& people, const std::string& suffix = "_2d");

/// Where the data beside the repository are (GESTUS_SHARED_DATA, or ../shared/data), or "".
std::string SharedData();

}  // namespace gestus::motion

#endif  // GESTUS_TESTS_MOTION_MOTION_DATA_H_
