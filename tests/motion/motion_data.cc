#include "tests/motion/motion_data.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace gestus::motion {
namespace {

std::string Numbers(const std::vector<Point>& points) {
  std::string text;
  for (const Point& p : points) {
    for (const float v : {p.x, p.y, p.confidence}) {
      text += (text.empty() ? "" : ",") + std::to_string(v);
    }
  }
  return "[" + text + "]";
}

}  // namespace

TempFolder::TempFolder() : path_(testing::TempDir() + "gestus_motion_XXXXXX") {
  EXPECT_NE(mkdtemp(path_.data()), nullptr);
}

TempFolder::~TempFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

std::string TempFolder::Write(const std::string& name, std::string_view content) const {
  const std::string path = path_ + "/" + name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

std::string FrameName(std::int64_t number) {
  const std::string digits = std::to_string(number);
  return "talk_" + std::string(12 - digits.size(), '0') + digits + "_keypoints.json";
}

Figure FigureAt(float x, float y, float confidence) {
  Figure figure;
  for (int i = 0; i < 25; ++i) {
    const auto at = static_cast<float>(i);
    figure.pose.push_back({x + at, y + 2 * at, confidence});
  }
  return figure;
}

std::string FrameText(const std::vector<Figure>& people, const std::string& suffix) {
  std::string text;
  for (const Figure& f : people) {
    text += (text.empty() ? "" : ",") + ("{\"pose_keypoints" + suffix) + "\":" + Numbers(f.pose) +
            ",\"face_keypoints" + suffix + "\":" + Numbers(f.face) + ",\"hand_left_keypoints" +
            suffix + "\":" + Numbers(f.left) + ",\"hand_right_keypoints" + suffix +
            "\":" + Numbers(f.right) + "}";
  }
  return "{\"version\":1.3,\"people\":[" + text + "]}";
}

std::string SharedData() {
  const char* set = std::getenv("GESTUS_SHARED_DATA");
  const std::string folder = set != nullptr ? set : GESTUS_SOURCE "/../shared/data";
  return std::filesystem::is_directory(folder) ? folder : "";
}

}  // namespace gestus::motion
