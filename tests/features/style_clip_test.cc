// FrontEnd::StyleClip, and the figure behind it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/features/figure.h"
#include "models/motion/clean.h"
#include "models/motion/resample.h"
#include "models/segments.h"
#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

// `frames` of a figure that moves and grows; every seventh frame has nobody.
std::string WritePoses(const TempFolder& folder, std::int64_t frames, bool face = true) {
  for (std::int64_t i = 0; i < frames; ++i) {
    const auto t = static_cast<float>(i);
    motion::Figure figure = motion::FigureAt(300 + 9 * std::sin(t / 5), 200 + t / 4);
    for (auto& point : figure.pose) point.x += (point.y - 200) * t / 50;
    for (int k = 0; face && k < 70; ++k) {
      const auto at = static_cast<float>(k);
      figure.face.push_back({280 + at + 3 * std::cos(t / 3), 150 - at / 2, 0.8f});
    }
    folder.Write(motion::FrameName(i),
                 motion::FrameText(i % 7 == 3 ? std::vector<motion::Figure>{}
                                              : std::vector<motion::Figure>{figure}));
  }
  return folder.path();
}

// The same by direct calls.
struct Want {
  std::vector<float> pose, face;
  std::int64_t frames = 0;
};
Want Direct(const std::string& path, double rate, const motion::PoseLayout& layout) {
  Want want;
  auto clip = motion::ReadOpenPose(path, {.frame_rate = rate});
  EXPECT_TRUE(clip.ok()) << clip.status().message();
  for (motion::Track* track : {&clip->body, &clip->face}) {
    if (track->frames == 0) continue;
    EXPECT_TRUE(motion::Clean(track, {.order = motion::CleanOrder::kFillFirst}).ok());
    *track = *motion::Resample(*track, 15);
  }
  const auto stances = motion::FindStances(clip->body);
  EXPECT_TRUE(stances.ok());
  want.pose = *motion::PoseColumns(clip->body, layout, stances->frames);
  if (clip->face.frames > 0)
    want.face = *motion::FaceColumns(clip->face, {30, 8}, layout.source, stances->frames);
  want.frames = clip->body.frames;
  return want;
}

class StyleClipTest : public testing::Test {
 protected:
  models::Arrays Clip(FrontEnd* front_end, const Recording& recording) {
    account_ = {};
    auto clip = front_end->StyleClip(recording, &account_);
    EXPECT_TRUE(clip.ok()) << clip.status().message();
    return clip.ok() ? *std::move(clip) : models::Arrays();
  }
  std::string Error(FrontEnd* front_end, const Recording& recording) {
    const auto clip = front_end->StyleClip(recording, &account_);
    return clip.ok() ? "" : clip.status().message();
  }
  // Columns of the first rows.
  static std::vector<float> First(std::vector<float> values, std::int64_t rows, int columns) {
    values.resize(static_cast<std::size_t>(rows * columns));
    return values;
  }

  TempFolder folder_, poses_;
  Account account_;
};

TEST_F(StyleClipTest, PosesAreThoseOfModelsMotion) {
  const std::string path = WritePoses(poses_, 75);
  const std::string audio = WriteWav(folder_, "a.wav", Voice(3.04, 8000), 8000);
  for (const bool zero : {false, true}) {
    const auto front_end = TalkFrontEnd({.neck_is_zero = zero});
    const models::Arrays clip = Clip(front_end.get(), {.audio = audio, .openpose = path});
    // 75 frames in 3.04 s: 24.67 a second, which is nearest to 25; 45 frames at 15.
    EXPECT_TRUE(Says(account_.notes, "taken for 25.00 frames per second"));
    motion::PoseLayout layout;
    layout.joints = {0, 1, 4};
    layout.neck = zero ? motion::NeckColumns::kZero : motion::NeckColumns::kPosition;
    const Want want = Direct(path, 25, layout);
    EXPECT_EQ(want.frames, 45);
    EXPECT_EQ(clip.at("style_pose").shape, (std::vector<std::int64_t>{45, 6}));
    EXPECT_EQ(clip.at("style_pose").f32, want.pose);
    EXPECT_EQ(clip.at("style_face").shape, (std::vector<std::int64_t>{45, 4}));
    EXPECT_EQ(clip.at("style_face").f32, want.face);
    EXPECT_EQ(zero, clip.at("style_pose").f32[0] == 0 && clip.at("style_pose").f32[3] == 0);
    EXPECT_EQ(clip.at("style_speech").shape[0], 45);
    EXPECT_TRUE(Says(account_.used, ": 75 frames -> style_pose, style_face"));
    EXPECT_TRUE(Says(account_.notes, "body: 11 frames of 75 lost"));
  }
}

TEST_F(StyleClipTest, TheRateOfPosesMayBeSaidOrUnknown) {
  const std::string path = WritePoses(poses_, 60);
  const auto front_end = TalkFrontEnd();
  motion::PoseLayout layout;
  layout.joints = {0, 1, 4};
  models::Arrays clip = Clip(front_end.get(), {.openpose = path, .pose_rate = 30});
  EXPECT_EQ(clip.at("style_pose").f32, Direct(path, 30, layout).pose);
  clip = Clip(front_end.get(), {.openpose = path});
  EXPECT_EQ(clip.at("style_pose").shape[0], 60);
  EXPECT_TRUE(Says(account_.notes, "taken for 15.00 frames per second, which OpenPose's files"));
  // A rate that nobody films at is taken as it is.
  const std::string audio = WriteWav(folder_, "a.wav", Voice(3.4, 8000), 8000);
  clip = Clip(front_end.get(), {.audio = audio, .openpose = path});
  EXPECT_TRUE(Says(account_.notes, "taken for 17.65 frames per second"));
}

TEST_F(StyleClipTest, StreamsEndTogether) {
  const std::string path = WritePoses(poses_, 45);
  const std::string audio = WriteWav(folder_, "a.wav", Voice(2, 8000), 8000);
  const auto front_end = TalkFrontEnd();
  const models::Arrays clip =
      Clip(front_end.get(), {.audio = audio, .openpose = path, .pose_rate = 15});
  motion::PoseLayout layout;
  layout.joints = {0, 1, 4};
  EXPECT_EQ(clip.at("style_pose").f32, First(Direct(path, 15, layout).pose, 30, 6));
  for (const char* name : {"style_speech", "style_text", "style_face"})
    EXPECT_EQ(clip.at(name).shape[0], 30) << name;
  EXPECT_EQ(clip.at("style_tags").shape, (std::vector<std::int64_t>{4, 3}));
  EXPECT_TRUE(Says(account_.notes, "the first 30 of 45 frames are taken"));
  // What is not there is the mean of its statistics.
  EXPECT_EQ(clip.at("style_text").f32, std::vector<float>(30 * 16, 0.5f));
  EXPECT_TRUE(Says(account_.notes, "style_tags: no words, so no dialog acts"));
}

TEST_F(StyleClipTest, EachSegmentHasTheDialogActsOfItsSentences) {
  const std::string path = WritePoses(poses_, 45);
  const std::vector<std::pair<std::string, std::pair<double, double>>> sentences = {
      {"word1 word2.", {0.1, 0.6}}, {"word7?", {0.8, 1.0}}, {"word15 word3 word3!", {1.5, 2.9}}};
  std::string text;
  for (const auto& [words, span] : sentences)
    text += std::to_string(span.first) + " " + std::to_string(span.second) + " " + words + "\n";
  const std::string transcript = folder_.Write("w.txt", text);

  const auto file = TalkFile();
  auto network = TokenNetwork::Make(file, "acts", {});
  ASSERT_TRUE(network.ok()) << network.status().message();
  ActClassifier classifier(*std::move(network));
  const std::vector<std::string> tags = {"statement", "thanks", "question"};  // of the network
  for (const std::vector<std::string>& order : {tags, std::vector<std::string>()}) {
    std::vector<float> want(6 * 3);  // 45 frames in segments of 8, the last from frame 37 on
    for (const auto& [words, span] : sentences) {
      const auto act = classifier.Classify(words);
      ASSERT_TRUE(act.ok());
      const std::string& label = classifier.labels()[static_cast<std::size_t>(act->label)];
      const std::vector<std::string>& columns = order.empty() ? classifier.labels() : order;
      const auto column = std::find(columns.begin(), columns.end(), label) - columns.begin();
      for (std::size_t i = 0; i < 6; ++i) {
        const double begin = (i == 5 ? 37 : 8 * static_cast<double>(i)) / 15;
        if (span.first < begin + 8.0 / 15 && span.second > begin)
          want[i * 3 + static_cast<std::size_t>(column)] = 1;
      }
    }
    const auto front_end = TalkFrontEnd({.tags = order});
    const models::Arrays clip =
        Clip(front_end.get(), {.transcript = transcript, .openpose = path, .pose_rate = 15});
    EXPECT_EQ(clip.at("style_tags").shape, (std::vector<std::int64_t>{6, 3}));
    EXPECT_EQ(clip.at("style_tags").f32, want);
    EXPECT_TRUE(Says(account_.used, "words -> style_tags"));
    EXPECT_GT(std::count(want.begin(), want.end(), 1.0f), 5);
  }
}

TEST_F(StyleClipTest, AnActThatTheNetworkDoesNotKnowIsAnError) {
  const std::string path = WritePoses(poses_, 20);
  const std::string transcript = folder_.Write("w.txt", "0.1 0.6 word1\n");
  const auto front_end = TalkFrontEnd({.tags = {"statement", "thanks", "answer"}});
  EXPECT_EQ(Error(front_end.get(), {.transcript = transcript, .openpose = path}),
            "talk.fb: dialog act question of the classifier is none of the network's tags");
}

TEST_F(StyleClipTest, WithoutAClassifierThereAreNoTags) {
  const std::string path = WritePoses(poses_, 20);
  const std::string transcript = folder_.Write("w.txt", "0.1 0.6 word1\n");
  const auto front_end = TalkFrontEnd({.texts = false});
  const models::Arrays clip = Clip(front_end.get(), {.transcript = transcript, .openpose = path});
  EXPECT_EQ(clip.at("style_tags").f32, std::vector<float>(9));
  EXPECT_TRUE(Says(account_.notes, "no classifier of dialog acts"));
  EXPECT_TRUE(Says(account_.notes, "text: the weights file has no BERT"));
}

TEST_F(StyleClipTest, PosesAreNeeded) {
  const std::string audio = WriteWav(folder_, "a.wav", Voice(2, 8000), 8000);
  const auto front_end = TalkFrontEnd();
  EXPECT_EQ(Error(front_end.get(), {.audio = audio}),
            "style: no poses, expected a folder of OpenPose's files or the array pose");
  const std::string path = WritePoses(poses_, 20, /*face=*/false);
  EXPECT_EQ(Error(front_end.get(), {.audio = audio, .openpose = path}),
            path + ": no face in any frame, expected the 70 points of OpenPose's --face");
}

TEST_F(StyleClipTest, ReadyArraysComeFirst) {
  const std::string path = WritePoses(poses_, 30);
  models::Array pose = RowsOf(std::vector<float>(30 * 6, 3), 30);
  const auto front_end = TalkFrontEnd();
  models::Arrays clip =
      Clip(front_end.get(), {.openpose = path, .pose_rate = 15, .arrays = {{"style_pose", pose}}});
  EXPECT_EQ(clip.at("style_pose").f32, pose.f32);
  EXPECT_EQ(clip.at("style_face").shape[0], 30);
  const models::Array face = clip.at("style_face");
  clip = Clip(front_end.get(),
              {.openpose = path, .arrays = {{"style_pose", pose}, {"style_face", face}}});
  EXPECT_EQ(clip.at("style_face").f32, face.f32);
  EXPECT_TRUE(Says(account_.notes, "was not used, style_pose is there already"));
}

TEST_F(StyleClipTest, ANetworkWithoutAStyleIsTold) {
  auto front_end = FrontEnd::Make(GoldenBert(), "bert", {});
  ASSERT_TRUE(front_end.ok());
  EXPECT_NE(Error(front_end->get(), {}).find("network bert has no style"), std::string::npos);
}

}  // namespace
}  // namespace gestus::features
