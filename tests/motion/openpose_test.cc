// OpenPose's files: versions, models, people, gaps and damage.
#include "models/motion/openpose.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/motion/joints.h"
#include "tests/motion/motion_data.h"

namespace gestus::motion {
namespace {

std::vector<Point> Points(int n, float x, float y, float confidence = 0.5f) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<float>(i);
    points.push_back({x + at, y + 2 * at, confidence});
  }
  return points;
}

Point At(const Track& track, std::int64_t frame, std::int64_t point) {
  return {track.value(frame, 0, point), track.value(frame, 1, point), track.seen(frame, point)};
}

void ExpectPoint(const Point& got, const Point& want, const std::string& what) {
  EXPECT_EQ(got.x, want.x) << what;
  EXPECT_EQ(got.y, want.y) << what;
  EXPECT_EQ(got.confidence, want.confidence) << what;
}

std::string Error(const std::string& text) {
  const Result<OpenPoseFrame> frame = ParseOpenPose(text);
  return frame.ok() ? "" : frame.status().message();
}

bool HasNote(const std::vector<std::string>& notes, const std::string& part) {
  for (const std::string& note : notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(OpenPoseTest, PutsPointsWherePatsHasThem) {
  const TempFolder folder;
  Figure figure = FigureAt(100, 200);
  figure.face = Points(70, 300, 10, 0.25f);
  figure.left = Points(21, 400, 20, 0.75f);
  figure.right = Points(21, 500, 30);
  for (const std::string suffix : {"_2d", ""}) {
    const auto clip = ReadOpenPose(folder.Write("frame.json", FrameText({figure}, suffix)));
    ASSERT_TRUE(clip.ok()) << clip.status().message();
    ASSERT_EQ(clip->body.frames, 1);
    ASSERT_EQ(clip->body.point_count(), 52);
    EXPECT_EQ(clip->body.frame_rate, 15);
    // Neck, shoulders, elbows, wrists, nose, eyes of BODY_25.
    const int body[] = {1, 2, 3, 4, 5, 6, 7, 0, 15, 16};
    for (int j = 0; j < 10; ++j) {
      const auto i = static_cast<float>(body[j]);
      ExpectPoint(At(clip->body, 0, j), {100 + i, 200 + 2 * i, 0.5f}, clip->body.points[j]);
    }
    for (int i = 0; i < 21; ++i) {
      const auto at = static_cast<float>(i);
      ExpectPoint(At(clip->body, 0, 10 + i), {400 + at, 20 + 2 * at, 0.75f}, "left hand");
      ExpectPoint(At(clip->body, 0, 31 + i), {500 + at, 30 + 2 * at, 0.5f}, "right hand");
    }
    for (int i = 0; i < 70; ++i) {
      const auto at = static_cast<float>(i);
      ExpectPoint(At(clip->face, 0, i), {300 + at, 10 + 2 * at, 0.25f}, "face");
    }
    EXPECT_TRUE(clip->notes.empty()) << clip->notes.front();
  }
}

TEST(OpenPoseTest, NamesJointsAsPatsDoes) {
  const std::vector<std::string> names = PatsJointNames();
  ASSERT_EQ(std::ssize(names), kPatsJoints);
  EXPECT_EQ(names[10], "LHandRoot");
  EXPECT_EQ(names[11], "LHandThumb1");
  EXPECT_EQ(names[30], "LHandLittle4");
  EXPECT_EQ(names[31], "RHandRoot");
  EXPECT_EQ(names[51], "RHandLittle4");
}

TEST(OpenPoseTest, ReadsCoco) {
  const TempFolder folder;
  Figure figure;
  figure.pose = Points(18, 100, 200);
  const auto clip = ReadOpenPose(folder.Write("frame.json", FrameText({figure}, "")));
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  const int body[] = {1, 2, 3, 4, 5, 6, 7, 0, 14, 15};
  for (int j = 0; j < 10; ++j) {
    const auto i = static_cast<float>(body[j]);
    ExpectPoint(At(clip->body, 0, j), {100 + i, 200 + 2 * i, 0.5f}, clip->body.points[j]);
  }
}

TEST(OpenPoseTest, TakesHandRootsFromWrists) {
  const TempFolder folder;
  const auto clip = ReadOpenPose(folder.Write("frame.json", FrameText({FigureAt(100, 200)})));
  ASSERT_TRUE(clip.ok());
  ExpectPoint(At(clip->body, 0, kLHandRoot), At(clip->body, 0, kLWrist), "left");
  ExpectPoint(At(clip->body, 0, kRHandRoot), At(clip->body, 0, kRWrist), "right");
  EXPECT_FALSE(clip->body.Has(11));
  EXPECT_EQ(clip->face.frames, 0);
  EXPECT_TRUE(HasNote(clip->notes, "no frame has LHandRoot"));
  EXPECT_TRUE(HasNote(clip->notes, "no frame has points of a face"));
}

TEST(OpenPoseTest, OrdersFramesByNumberAndKeepsGaps) {
  const TempFolder folder;
  for (const int number : {9, 10, 7, 100}) {
    folder.Write(FrameName(number), FrameText({FigureAt(static_cast<float>(number), 1)}));
  }
  folder.Write(FrameName(8), FrameText({}));
  folder.Write("readme.txt", "not a frame");
  const auto clip = ReadOpenPose(folder.path(), {.frame_rate = 29.97});
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  EXPECT_EQ(clip->body.frames, 94);
  EXPECT_EQ(clip->body.frame_rate, 29.97);
  EXPECT_EQ(clip->body.value(0, 0, kNeck), 8);
  EXPECT_EQ(clip->body.seen(1, kNeck), 0);
  EXPECT_EQ(clip->body.value(2, 0, kNeck), 10);
  EXPECT_EQ(clip->body.value(3, 0, kNeck), 11);
  EXPECT_EQ(clip->body.seen(50, kNeck), 0);
  EXPECT_EQ(clip->body.value(93, 0, kNeck), 101);
  EXPECT_TRUE(HasNote(clip->notes, "89 frames without a file"));
  EXPECT_TRUE(HasNote(clip->notes, "1 frame without people"));
  EXPECT_TRUE(HasNote(clip->notes, "the first frame has number 7"));
}

// Two people walk towards each other and pass; they come in changing order, and the other one is
// found better later on.
TEST(OpenPoseTest, FollowsOnePerson) {
  const TempFolder folder;
  constexpr int kFrames = 40;
  for (int t = 0; t < kFrames; ++t) {
    const auto at = static_cast<float>(t);
    Figure ours = FigureAt(100 + 5 * at, 300, t == 0 ? 0.9f : 0.3f);
    Figure other = FigureAt(300 - 5 * at, 340, t == 0 ? 0.8f : 0.95f);
    std::vector<Figure> people = {other, ours};
    if (t % 3 == 0) std::swap(people[0], people[1]);
    if (t % 7 == 5) std::erase_if(people, [](const Figure& f) { return f.pose[0].y == 300; });
    folder.Write(FrameName(t), FrameText(people));
  }
  const auto clip = ReadOpenPose(folder.path());
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  for (int t = 0; t < kFrames; ++t) {
    if (t % 7 == 5) {
      EXPECT_EQ(clip->body.seen(t, kNeck), 0) << t;
      continue;
    }
    EXPECT_EQ(clip->body.value(t, 0, kNeck), static_cast<float>(101 + 5 * t)) << t;
    EXPECT_EQ(clip->body.value(t, 1, kNeck), 302) << t;
  }
  EXPECT_TRUE(HasNote(clip->notes, "35 frames with several people"));
  EXPECT_TRUE(HasNote(clip->notes, "5 frames in which only others are seen"));
}

TEST(OpenPoseTest, FindsThePersonAgainAfterACut) {
  const TempFolder folder;
  for (int t = 0; t < 40; ++t) {
    folder.Write(FrameName(t), FrameText({FigureAt(t < 10 ? 100.0f : 400.0f, 300)}));
  }
  const auto clip = ReadOpenPose(folder.path());
  ASSERT_TRUE(clip.ok());
  // 300 pixels away, 32 tall: near enough after 300 / 16 frames, rounded up.
  EXPECT_EQ(clip->body.seen(27, kNeck), 0);
  EXPECT_GT(clip->body.seen(28, kNeck), 0);
  EXPECT_TRUE(HasNote(clip->notes, "18 frames in which only others are seen"));
}

TEST(OpenPoseTest, TakesPointsThatWereNotFound) {
  const TempFolder folder;
  Figure figure = FigureAt(100, 200);
  figure.pose[1] = {0, 0, 0};
  figure.pose[2] = {0, 0, 0.5f};
  figure.pose[3] = {7, 8, 0};
  figure.pose[4] = {7, 8, 1.03125f};
  figure.pose[5] = {0, 8, 0.5f};
  std::string text = FrameText({figure});
  const std::string wrist = "107.000000,214.000000";
  ASSERT_NE(text.find(wrist), std::string::npos);
  text.replace(text.find(wrist), wrist.size(), "107.0,null");
  const auto clip = ReadOpenPose(folder.Write("frame.json", text));
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  for (const int lost : {0, 1, 2, 6}) ExpectPoint(At(clip->body, 0, lost), {}, "lost");
  ExpectPoint(At(clip->body, 0, 3), {7, 8, 1}, "confidence above 1");
  ExpectPoint(At(clip->body, 0, 4), {0, 8, 0.5f}, "at the edge");
  EXPECT_TRUE(HasNote(clip->notes, "1 point given as null"));
}

TEST(OpenPoseTest, SaysWhichFieldIsWrong) {
  EXPECT_EQ(Error("{"), "is not JSON at byte 2, expected a JSON document");
  for (const char* text : {"[]", "{}", "{\"people\":null}", "{\"people\":{}}", "1"}) {
    EXPECT_EQ(Error(text), "has no array \"people\", expected a frame of OpenPose") << text;
  }
  EXPECT_EQ(Error("{\"people\":[5]}"), "people[0]: 5.00000, expected a person's key points");
  EXPECT_EQ(Error("{\"people\":[{}]}"),
            "people[0]: has no pose_keypoints_2d, expected OpenPose's key points");
  EXPECT_EQ(Error("{\"people\":[{\"pose_keypoints_2d\":\"x\"}]}"),
            "people[0].pose_keypoints_2d: a JSON string, expected an array of numbers");
  Figure figure = FigureAt(1, 1);
  figure.pose.pop_back();
  EXPECT_EQ(
      Error(FrameText({FigureAt(1, 1), figure})),
      "people[1].pose_keypoints_2d: has 72 numbers, expected 75 (BODY_25), 54 (COCO) or none");
  figure = FigureAt(1, 1);
  figure.face = Points(68, 1, 1);
  EXPECT_EQ(Error(FrameText({figure}, "")),
            "people[0].face_keypoints: has 204 numbers, expected 210 or none");
  figure.face.clear();
  figure.right = Points(20, 1, 1);
  EXPECT_EQ(Error(FrameText({figure})),
            "people[0].hand_right_keypoints_2d: has 60 numbers, expected 63 or none");
  std::string text = FrameText({FigureAt(1, 1)});
  text.replace(text.find("1.000000"), 8, "1e7");
  EXPECT_EQ(Error(text),
            "people[0].pose_keypoints_2d[0]: 10000000, expected a number within 1000000 of 0");
  text.replace(text.find("1e7"), 3, "[1]");
  EXPECT_EQ(Error(text),
            "people[0].pose_keypoints_2d[0]: a JSON array, expected a number within 1000000 of 0");
}

TEST(OpenPoseTest, SaysWhatIsWrongWithAFolder) {
  const auto error = [](const std::string& path, const OpenPoseOptions& options = {}) {
    const std::string message = ReadOpenPose(path, options).status().message();
    return message.starts_with(path + ": ") ? message.substr(path.size() + 2) : message;
  };
  const std::string frame = FrameText({FigureAt(1, 1)});
  const TempFolder empty;
  EXPECT_EQ(error(empty.path()),
            "holds no file named *<number>_keypoints.json, expected OpenPose's frames");
  EXPECT_NE(error(empty.path() + "/none").find("cannot be opened"), std::string::npos);

  const TempFolder unnumbered;
  unnumbered.Write("talk_keypoints.json", frame);
  EXPECT_EQ(error(unnumbered.path()),
            "talk_keypoints.json: no frame number before _keypoints.json, expected names like "
            "talk_000000000012_keypoints.json");
  const TempFolder large_number;
  large_number.Write("99999999999999999999_keypoints.json", frame);
  EXPECT_NE(error(large_number.path()).find("no frame number"), std::string::npos);

  const TempFolder two;
  two.Write("a_0_keypoints.json", frame);
  two.Write("b_0_keypoints.json", frame);
  EXPECT_EQ(error(two.path()),
            "holds a_0_keypoints.json and b_0_keypoints.json, expected the frames of one clip");
  const TempFolder twice;
  twice.Write("a_0_keypoints.json", frame);
  twice.Write("a_00_keypoints.json", frame);
  EXPECT_EQ(error(twice.path()), "frame 0 is there twice, expected once");

  const TempFolder far;
  far.Write(FrameName(0), frame);
  far.Write(FrameName(500000), frame);
  EXPECT_EQ(error(far.path()),
            "frames 0 to 500000, but only 2 of them are there, expected numbers that follow each "
            "other");
  far.Write("talk_9223372036854775807_keypoints.json", frame);
  EXPECT_EQ(error(far.path()),
            "frames 0 to 9223372036854775807, expected at most 1,048,576 frames");
  EXPECT_EQ(error(far.path(), {.max_frames = 2}),
            "holds more than 2 frames, expected at most as many");
  EXPECT_EQ(error(far.path(), {.frame_rate = 0}),
            "the frame rate is 0, expected 1 to 1000 frames per second");

  const TempFolder damaged;
  damaged.Write(FrameName(0), frame);
  damaged.Write(FrameName(1), frame.substr(0, 100));
  EXPECT_EQ(error(damaged.path()), damaged.path() + "/" + FrameName(1) +
                                       ": is not JSON at byte 101, expected a JSON document");
  EXPECT_NE(error(damaged.path(), {.max_file_bytes = 50}).find("expected at most 50 B"),
            std::string::npos);

  const TempFolder nobody;
  nobody.Write(FrameName(0), FrameText({}));
  nobody.Write(FrameName(1), FrameText({Figure()}));
  EXPECT_EQ(error(nobody.path()), "nobody in any of 2 frames, expected a person with a body");
}

TEST(OpenPoseTest, NotesCoordinatesThatAreNoPixels) {
  const TempFolder folder;
  Figure figure;
  for (int i = 0; i < 25; ++i) figure.pose.push_back({0.01f * static_cast<float>(i), 0.5f, 0.5f});
  const auto clip = ReadOpenPose(folder.Write("frame.json", FrameText({figure})));
  ASSERT_TRUE(clip.ok());
  EXPECT_TRUE(HasNote(clip->notes, "keypoint_scale"));
}

TEST(OpenPoseTest, ReadsTheRealFile) {
  if (SharedData().empty()) GTEST_SKIP() << "no data beside the repository (GESTUS_SHARED_DATA)";
  const auto clip = ReadOpenPose(SharedData() + "/spin_openpose/im1010_openpose.json");
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  ExpectPoint(At(clip->body, 0, kNeck), {78.5691f, 57.8892f, 0.628322f}, "neck");
  ExpectPoint(At(clip->body, 0, kRShoulder), {74.1715f, 57.8883f, 0.568593f}, "shoulder");
  EXPECT_FALSE(clip->body.Has(kRWrist));
  ExpectPoint(At(clip->body, 0, 30), {76.0895f, 109.829f, 0.0484347f}, "last finger");
  EXPECT_FALSE(clip->body.Has(kRHandRoot));
  EXPECT_EQ(clip->face.frames, 0);
}

}  // namespace
}  // namespace gestus::motion
