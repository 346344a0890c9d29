#include "models/outputs/formats.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "models/motion/joints.h"
#include "models/motion/openface.h"
#include "models/motion/openpose.h"

namespace gestus::outputs {
namespace {

namespace fs = std::filesystem;

class FormatsTest : public testing::Test {
 protected:
  FormatsTest() {
    std::string name = testing::TempDir() + "formats-XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~FormatsTest() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ + "/" + name; }

  std::string Text(const std::string& name) const {
    std::ifstream file(Path(name), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  /// The names of what there is.
  std::vector<std::string> List(const std::string& name = "") const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(Path(name)))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// What WriteMotion says where it must fail; nothing may be left behind.
  std::string Refusal(const Motion& motion, Format format, const FormatOptions& options = {}) {
    const auto before = List();
    const Status status = WriteMotion(motion, format, Path("refused"), options);
    EXPECT_FALSE(status.ok());
    EXPECT_EQ(status.message().find(Path("refused") + ": "), 0u) << status.message();
    EXPECT_EQ(status.message().find('\n'), std::string::npos);
    EXPECT_EQ(List(), before);
    return status.message().substr(std::min(status.message().size(), Path("refused: ").size()));
  }

  std::string folder_;
};

float Wave(std::int64_t frame, std::int64_t column) {
  return 200.0f * std::sin(0.37f * static_cast<float>(frame) + 1.7f * static_cast<float>(column));
}

/// The 52 joints of PATS and the 70 points of a face, moving anyhow.
Motion WholeFigure(std::int64_t frames, bool normalised = true) {
  Motion motion;
  motion.frames = frames;
  motion.normalised = normalised;
  Figure& body = motion.body.emplace();
  Figure& face = motion.face.emplace();
  for (const std::string& name : motion::PatsJointNames())
    body.points.push_back({name, -1, std::ssize(body.points)});
  for (const std::string& name : motion::FacePointNames())
    face.points.push_back({name, -1, std::ssize(face.points)});
  for (std::int64_t t = 0; t < frames; ++t) {
    for (std::int64_t i = 0; i < 104; ++i) body.values.push_back(Wave(t, i));
    for (std::int64_t i = 0; i < 140; ++i) face.values.push_back(Wave(t, 200 + i));
    // The shoulder has the length that PATS gives it.
    body.values[static_cast<std::size_t>(t * 104 + 1)] = -167;
    body.values[static_cast<std::size_t>(t * 104 + 53)] = 0;
  }
  return motion;
}

Motion Talking(std::int64_t frames, double rate = 24) {
  Motion motion;
  motion.frames = frames;
  motion.frame_rate = rate;
  Curves& curves = motion.curves.emplace();
  for (const char* name : {"AU01", "AU02", "AU04", "AU05", "AU06", "AU07", "Rx", "Ry", "Rz"})
    curves.curves.push_back({name, "", 0, 5});
  for (std::int64_t t = 0; t < frames; ++t) {
    for (std::int64_t i = 0; i < 9; ++i)
      curves.values.push_back(i < 6 ? 2.5f + Wave(t, i) / 100 : Wave(t, i) / 400);
  }
  return motion;
}

TEST_F(FormatsTest, NamesAreKnownBothWays) {
  EXPECT_EQ(FormatNames().size(), 11u);
  for (const std::string& name : FormatNames()) {
    const Result<Format> format = FormatOf(name);
    ASSERT_TRUE(format.ok()) << name;
    EXPECT_EQ(NameOf(*format), name);
  }
  EXPECT_EQ(
      FormatOf("f\x1b"
               "bx")
          .status()
          .message(),
      "format \"f\\x1bbx\" is unknown, expected one of openpose, openface, openface2, csv, bvh, "
      "bvh3d, arkit, vrm, vrma, fap, bap");
}

// Written, read by our own reader and laid out again: the motion, within a thousandth of a pixel of
// the picture.
TEST_F(FormatsTest, OpenPoseComesBack) {
  const Motion motion = WholeFigure(5);
  FormatOptions options;
  for (int t = 0; t < 5; ++t)
    options.stances.push_back({500.0f + static_cast<float>(t), 300, 60.0f + static_cast<float>(t)});
  ASSERT_TRUE(WriteMotion(motion, Format::kOpenPose, Path("clip"), options).ok());
  const Result<motion::OpenPoseClip> clip = motion::ReadOpenPose(Path("clip"));
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  const Result<motion::Stances> stances = motion::FindStances(clip->body);
  ASSERT_TRUE(stances.ok()) << stances.status().message();
  motion::PoseLayout layout;
  for (std::int32_t j = 0; j < 52; ++j) layout.joints.push_back(j);
  std::vector<std::int32_t> landmarks;
  for (std::int32_t i = 0; i < 70; ++i) landmarks.push_back(i);
  const auto pose = motion::PoseColumns(clip->body, layout, stances->frames);
  const auto face = motion::FaceColumns(clip->face, landmarks, layout.source, stances->frames);
  ASSERT_TRUE(pose.ok() && face.ok());
  for (std::size_t t = 0; t < 5; ++t) {
    EXPECT_NEAR(stances->frames[t].neck_x, options.stances[t].neck_x, 1e-3);
    EXPECT_NEAR(stances->frames[t].shoulder, options.stances[t].shoulder, 1e-3);
    for (std::size_t i = 0; i < 104; ++i) {
      if (i % 52 == 0) continue;  // the neck's columns are its place in the picture
      EXPECT_NEAR((*pose)[t * 104 + i], motion.body->values[t * 104 + i], 2e-2) << t << " " << i;
    }
    for (std::size_t i = 0; i < 140; ++i)
      EXPECT_NEAR((*face)[t * 140 + i], motion.face->values[t * 140 + i], 2e-2) << t << " " << i;
  }
}

TEST_F(FormatsTest, PixelsStayPixels) {
  const Motion motion = WholeFigure(2, /*normalised=*/false);
  ASSERT_TRUE(WriteMotion(motion, Format::kOpenPose, Path("clip/")).ok());
  const Result<motion::OpenPoseClip> clip = motion::ReadOpenPose(Path("clip"));
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  EXPECT_NEAR(clip->body.value(1, 0, 3), 640 + motion.body->x(1, 3), 1e-3);
  EXPECT_NEAR(clip->body.value(1, 1, 3), 360 + motion.body->y(1, 3), 1e-3);
  EXPECT_NEAR(clip->body.value(1, 0, 0), 640, 1e-3);
}

TEST_F(FormatsTest, OpenFaceComesBack) {
  for (const Format format : {Format::kOpenFace, Format::kOpenFace2}) {
    for (const double rate : {24.0, 25.0, 15.0}) {
      const Motion motion = Talking(100, rate);
      ASSERT_TRUE(WriteMotion(motion, format, Path("face.csv")).ok());
      const std::vector<std::string> columns = {"AU01_r", "AU02_r",  "AU04_r",  "AU05_r", "AU06_r",
                                                "AU07_r", "pose_Rx", "pose_Ry", "pose_Rz"};
      const Result<motion::OpenFaceClip> clip =
          motion::ReadOpenFace(Path("face.csv"), {.columns = columns});
      ASSERT_TRUE(clip.ok()) << clip.status().message();
      EXPECT_EQ(clip->track.frame_rate, rate);
      ASSERT_EQ(clip->track.frames, 100);
      for (std::size_t i = 0; i < motion.curves->values.size(); ++i)
        EXPECT_NEAR(clip->track.values[i], motion.curves->values[i], 1e-6) << i;
      EXPECT_EQ(clip->track.seen(50, 0), 1);
    }
  }
}

TEST_F(FormatsTest, EveryFormatIsRefusedWhereItHasNothingToSay) {
  const Motion figure = WholeFigure(3), face = Talking(3);
  for (const Format format : {Format::kOpenPose, Format::kBvh, Format::kBvh3d})
    EXPECT_EQ(Refusal(face, format),
              "the motion has no body, which the format " + NameOf(format) + " needs");
  for (const Format format : {Format::kOpenFace, Format::kArkit, Format::kVrm})
    EXPECT_EQ(Refusal(figure, format),
              "the motion has no action units and head angles, which the "
              "format " +
                  NameOf(format) + " needs");
  EXPECT_EQ(Refusal(figure, Format::kFap),
            "the motion has no action units of brows, lids or cheeks, which the format fap needs");
  Motion torso = figure;
  torso.body->points[5].source = torso.body->points[2].source = 1;
  torso.body->points[6].source = torso.body->points[3].source = 1;
  torso.body->points[7].source = 1;
  EXPECT_EQ(Refusal(torso, Format::kVrma),
            "the motion has no arms and no nose, which the format vrma needs");
  EXPECT_EQ(Refusal(torso, Format::kBap),
            "the motion has no head angles, no arms and no nose, which the format bap needs");
  Motion odd = face;
  for (Curve& curve : odd.curves->curves) curve.name = "?" + curve.name;
  EXPECT_FALSE(WriteMotion(odd, Format::kArkit, Path("odd.csv")).ok());
  EXPECT_NE(Refusal(odd, Format::kVrma).find("no body, action units or head angles"),
            std::string::npos);
  EXPECT_TRUE(WriteMotion(odd, Format::kCsv, Path("odd.csv")).ok());
}

TEST_F(FormatsTest, MotionsThatAreNone) {
  const std::vector<std::pair<std::function<void(Motion*)>, std::string>> cases = {
      {[](Motion* m) { m->frames = 0; }, "a motion without frames"},
      {[](Motion* m) { m->body.reset(), m->face.reset(); }, "a motion of nothing"},
      {[](Motion* m) { m->frame_rate = 0; }, "frame"},
      {[](Motion* m) { m->frame_rate = std::nan(""); }, "frame"},
      {[](Motion* m) { m->body->values.pop_back(); }, "body: 311 values, expected 3 x 104"},
      {[](Motion* m) { m->face->points.clear(); }, "face: no points"},
      {[](Motion* m) { m->body->values[200] = std::numeric_limits<float>::infinity(); },
       "body: no number within 1e9 of 0 in frame 1"},
      {[](Motion* m) { m->face->values[0] = std::nanf(""); },
       "face: no number within 1e9 of 0 in frame 0"},
  };
  for (const auto& [damage, says] : cases) {
    Motion motion = WholeFigure(3);
    damage(&motion);
    for (const Format format : {Format::kCsv, Format::kOpenPose, Format::kBvh, Format::kBvh3d})
      EXPECT_NE(Refusal(motion, format).find(says), std::string::npos) << says;
  }
  Motion motion = WholeFigure(3);
  EXPECT_NE(
      Refusal(motion, Format::kOpenPose, {.stances = {{}, {}}}).find("2 stances for 3 frames"),
      std::string::npos);
  EXPECT_NE(
      Refusal(motion, Format::kOpenPose, {.stances = {{0, 0, 0}}}).find("a stance that is no"),
      std::string::npos);
  motion.body->points[4].source = 52;
  EXPECT_NE(Refusal(motion, Format::kOpenPose).find("expected 0 to 51"), std::string::npos);
  motion = WholeFigure(3);
  motion.face->points[4].source = 70;
  EXPECT_NE(Refusal(motion, Format::kOpenPose).find("expected 0 to 69"), std::string::npos);
}

TEST_F(FormatsTest, OneFrameAndMissingJoints) {
  Motion one = WholeFigure(1);
  one.body->points = {{"RWrist", -1, 3}};
  one.body->values = {0, 0};  // a bone without length
  one.face.reset();
  for (const Format format :
       {Format::kOpenPose, Format::kCsv, Format::kBvh, Format::kBvh3d, Format::kVrma}) {
    const std::string name = "one." + NameOf(format);
    EXPECT_TRUE(WriteMotion(one, format, Path(name)).ok());
    EXPECT_EQ(Text(name).find("nan"), std::string::npos);
  }
  EXPECT_TRUE(motion::ReadOpenPose(Path("one.openpose")).ok());
  Motion limp = WholeFigure(1);
  limp.body->points[2].source = 1;  // no right elbow, and a left forearm without length
  limp.face.reset();
  limp.body->values.assign(limp.body->values.size(), 0);
  EXPECT_TRUE(WriteMotion(limp, Format::kBap, Path("limp.bap")).ok());
  EXPECT_NE(Text("limp.bap").find("\n0 0 0 0 0 0 \n"), std::string::npos) << Text("limp.bap");
  const Motion talking = Talking(1);
  for (const Format format :
       {Format::kOpenFace, Format::kArkit, Format::kVrm, Format::kVrma, Format::kFap, Format::kBap})
    EXPECT_TRUE(WriteMotion(talking, format, Path("one." + NameOf(format))).ok());
  Motion head = Talking(2);
  head.curves->curves = {{"pose_Ry", "rad", 0, 0}};
  head.curves->values = {0.25f, -0.25f};
  ASSERT_TRUE(WriteMotion(head, Format::kBap, Path("head.bap")).ok());
  EXPECT_NE(Text("head.bap").find("\n0 0 -25000 0 \n"), std::string::npos);
  EXPECT_FALSE(WriteMotion(head, Format::kFap, Path("head.fap")).ok());
}

TEST_F(FormatsTest, TooManyPointsForASkeleton) {
  Motion motion;
  motion.frames = 1;
  motion.body.emplace();
  for (int i = 0; i < 1001; ++i) motion.body->points.push_back({"p", i - 1, 60});
  motion.body->values.resize(2002);
  EXPECT_NE(Refusal(motion, Format::kBvh).find("1,001 points, expected at most 1,000"),
            std::string::npos);
  motion.body->points.pop_back();
  motion.body->values.resize(2000);
  EXPECT_TRUE(WriteMotion(motion, Format::kBvh3d, Path("long.bvh")).ok());  // a chain of 1000 bones
}

TEST_F(FormatsTest, NumbersDoNotFollowTheLocale) {
  const Motion motion = Talking(3);
  ASSERT_TRUE(WriteMotion(motion, Format::kArkit, Path("plain.csv")).ok());
  const std::string plain = Text("plain.csv");
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr &&
      std::setlocale(LC_ALL, "fr_FR.UTF-8") == nullptr)
    GTEST_SKIP() << "this machine has no locale with a decimal comma";
  EXPECT_TRUE(WriteMotion(motion, Format::kArkit, Path("other.csv")).ok());
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(Text("other.csv"), plain);
}

TEST_F(FormatsTest, AFolderIsReplacedOnlyByItsLike) {
  ASSERT_TRUE(WriteMotion(WholeFigure(4), Format::kOpenPose, Path("clip")).ok());
  EXPECT_EQ(List("clip").size(), 4u);
  ASSERT_TRUE(WriteMotion(WholeFigure(2), Format::kOpenPose, Path("clip"), {.name = "a b/c"}).ok());
  EXPECT_EQ(List("clip"), (std::vector<std::string>{"a_b_c_000000000000_keypoints.json",
                                                    "a_b_c_000000000001_keypoints.json"}));
  EXPECT_EQ(List(), (std::vector<std::string>{"clip"}));
  std::ofstream(Path("clip/thesis.txt")) << "mine";
  const Status status = WriteMotion(WholeFigure(2), Format::kOpenPose, Path("clip"));
  EXPECT_NE(status.message().find("holds \"thesis.txt\""), std::string::npos) << status.message();
  EXPECT_EQ(List("clip").size(), 3u);
  fs::create_directory(Path("empty"));
  EXPECT_TRUE(WriteMotion(WholeFigure(2), Format::kOpenPose, Path("empty")).ok());
  fs::create_directory_symlink("empty", Path("link"));
  EXPECT_TRUE(WriteMotion(WholeFigure(3), Format::kOpenPose, Path("link")).ok());
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(List("empty").size(), 3u);
  std::ofstream(Path("file")) << "mine";
  EXPECT_NE(
      WriteMotion(WholeFigure(2), Format::kOpenPose, Path("file")).message().find("no folder"),
      std::string::npos);
  EXPECT_FALSE(WriteMotion(WholeFigure(2), Format::kOpenPose, Path("no/where")).ok());
  EXPECT_FALSE(WriteMotion(WholeFigure(2), Format::kOpenPose, "").ok());
  EXPECT_EQ(List(), (std::vector<std::string>{"clip", "empty", "file", "link"}));
}

TEST_F(FormatsTest, AFileIsReplacedAndAFolderIsNot) {
  fs::create_directory(Path("folder"));
  for (const Format format : {Format::kOpenFace, Format::kCsv, Format::kArkit, Format::kVrm,
                              Format::kVrma, Format::kFap, Format::kBap}) {
    EXPECT_TRUE(WriteMotion(Talking(30), format, Path("out")).ok());
    EXPECT_TRUE(WriteMotion(Talking(2), format, Path("out")).ok());
    EXPECT_FALSE(WriteMotion(Talking(2), format, Path("folder")).ok());
    EXPECT_FALSE(WriteMotion(Talking(2), format, Path("no/where")).ok());
  }
  EXPECT_EQ(List(), (std::vector<std::string>{"folder", "out"}));
}

}  // namespace
}  // namespace gestus::outputs
