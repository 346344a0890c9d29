// Files that were cut or changed: a clip or one line, never anything else.  The sanitizers watch.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "models/io/text.h"
#include "models/motion/clean.h"
#include "models/motion/openface.h"
#include "models/motion/openpose.h"
#include "models/motion/resample.h"
#include "models/motion/select.h"
#include "tests/motion/motion_data.h"

namespace gestus::motion {
namespace {

void ExpectOneLine(const Status& status) {
  EXPECT_FALSE(status.message().empty());
  EXPECT_EQ(status.message().find('\n'), std::string::npos);
  EXPECT_LT(status.message().size(), 400u) << status.message();
}

// What follows the readers in a run.
void ExpectUsable(Track* track) {
  EXPECT_EQ(std::ssize(track->values), track->frames * track->columns());
  for (const float v : track->values) ASSERT_LE(std::abs(v), 1e6f);
  for (const float c : track->confidence) ASSERT_TRUE(c >= 0 && c <= 1);
  ASSERT_TRUE(Clean(track).ok());
  ASSERT_TRUE(Resample(*track, 15).ok());
}

std::string Mutate(std::string text, const std::string& pieces, std::mt19937* random) {
  for (unsigned n = 1 + (*random)() % 2; n > 0; --n) {
    const std::size_t at = (*random)() % text.size();
    switch ((*random)() % 4) {
      case 0:
        text[at] = static_cast<char>((*random)());
        break;
      case 1:
        text[at] = pieces[(*random)() % pieces.size()];
        break;
      case 2:
        text.erase(at, 1 + (*random)() % 20);
        break;
      default:
        text.insert(at, text.substr((*random)() % text.size(), 1 + (*random)() % 40));
    }
    if (text.empty()) text = " ";
  }
  return text;
}

std::string OpenPoseText() {
  Figure a = FigureAt(500, 300), b = FigureAt(100, 200, 0.25f);
  a.left.assign(21, {5, 6, 0.5f});
  a.face.assign(70, {7, 8, 0.5f});
  return FrameText({a, b});
}

TEST(MotionDamageTest, OpenPoseCut) {
  const std::string text = OpenPoseText();
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto frame = ParseOpenPose(std::string_view(text).substr(0, n));
    ASSERT_FALSE(frame.ok()) << n;
    ExpectOneLine(frame.status());
  }
}

TEST(MotionDamageTest, OpenPoseChanged) {
  const TempFolder folder;
  const std::string text = OpenPoseText();
  std::mt19937 random(7);
  int good = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::string path =
        folder.Write("frame.json", Mutate(text, "[]{},:\"0123456789.e-nul", &random));
    auto clip = ReadOpenPose(path);
    if (!clip.ok()) {
      ExpectOneLine(clip.status());
      continue;
    }
    ++good;
    ASSERT_NO_FATAL_FAILURE(ExpectUsable(&clip->body));
    const auto stances = FindStances(clip->body);
    if (!stances.ok()) continue;
    EXPECT_TRUE(PoseColumns(clip->body, {{0, 1}}, stances->frames).ok());
  }
  EXPECT_GT(good, 75);
  EXPECT_LT(good, 1400);
}

TEST(MotionDamageTest, OpenFaceCutAndChanged) {
  const TempFolder folder;
  std::string text = "frame, face_id, timestamp, confidence, success, pose_Rx, AU01_r, AU45_r\n";
  for (int t = 0; t < 12; ++t) {
    for (int face = 0; face < 2; ++face) {
      text += std::to_string(t) + ", " + std::to_string(face) + ", 0." +
              std::to_string(t * 4 + 10) + ", 0.9, " + std::to_string(t % 5 != 0) +
              ", -0.1, 0.5, 1.25\n";
    }
  }
  std::mt19937 random(8);
  int good = 0;
  const auto check = [&](const std::string& content) {
    auto clip = ReadOpenFace(folder.Write("face.csv", content));
    if (!clip.ok()) return ExpectOneLine(clip.status());
    ++good;
    ExpectUsable(&clip->track);
  };
  for (std::size_t n = 0; n < text.size(); ++n) {
    ASSERT_NO_FATAL_FAILURE(check(text.substr(0, n))) << n;
  }
  for (int i = 0; i < 3000; ++i) {
    ASSERT_NO_FATAL_FAILURE(check(Mutate(text, ", \n\r0123456789.e-nafAU_r\"", &random))) << i;
  }
  EXPECT_GT(good, 300);
}

}  // namespace
}  // namespace gestus::motion
