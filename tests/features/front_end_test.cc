#include "models/features/front_end.h"

#include <gtest/gtest.h>

#include "models/features/stages.h"
#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

using Names = std::vector<std::string>;

TEST(StretchTest, HoldsAboutTheMostAndLeavesAUnitOrNothing) {
  EXPECT_EQ(Stretch(100, 8, 32), 32);
  EXPECT_EQ(Stretch(100, 8, 39), 32);
  EXPECT_EQ(Stretch(40, 8, 32), 32);
  EXPECT_EQ(Stretch(39, 8, 32), 39);
  EXPECT_EQ(Stretch(5, 8, 32), 5);
  EXPECT_EQ(Stretch(100, 64, 32), 100);  // 36 would be left
  EXPECT_EQ(Stretch(200, 64, 32), 64);
  EXPECT_EQ(Stretch(1, 1, 4096), 1);
  for (std::int64_t total = 1; total < 300; ++total) {
    for (std::int64_t left = total; left > 0;) {
      const std::int64_t count = Stretch(left, 8, 32);
      ASSERT_GT(count, 0);
      ASSERT_LE(count, left);
      ASSERT_TRUE(count == left || count % 8 == 0);
      left -= count;
      ASSERT_TRUE(left == 0 || left >= 8) << total;
    }
  }
}

TEST(MakesTest, NamesWhatTheRecordingIsGoodFor) {
  FeatureSpec spec = FramesSpec();
  EXPECT_EQ(FrontEnd::Makes(spec, {}), Names());
  EXPECT_EQ(FrontEnd::Makes(spec, {.openpose = "poses"}), Names());
  EXPECT_EQ(FrontEnd::Makes(spec, {.audio = "a.wav"}), (Names{"speech", "text"}));
  EXPECT_EQ(FrontEnd::Makes(spec, {.transcript = "w"}), (Names{"speech", "text"}));
  spec.d_text = 0;
  EXPECT_EQ(FrontEnd::Makes(spec, {.audio = "a.wav"}), Names{"speech"});
  EXPECT_EQ(FrontEnd::Makes(spec, {.transcript = "w"}), Names());
  spec.layout = Layout::kWindows;
  EXPECT_EQ(FrontEnd::Makes(spec, {.transcript = "w"}), (Names{"f0", "text"}));
  spec.layout = Layout::kSentences;
  EXPECT_EQ(FrontEnd::Makes(spec, {.audio = "a.wav", .transcript = "w"}), Names());
}

TEST(FrontEndTest, MakesTheInputsOfTheNetwork) {
  const TempFolder folder;
  const std::string audio = WriteWav(folder, "a.wav", Voice(2, 8000), 8000);
  const std::string words = folder.Write("w.txt", "0.1 0.5 word1\n0.5 1.0 word2\n");
  const auto front_end = TalkFrontEnd();
  Account account;
  auto stream = front_end->Open({.audio = audio, .transcript = words, .openpose = "p"}, &account);
  ASSERT_TRUE(stream.ok()) << stream.status().message();
  EXPECT_EQ((*stream)->total(), 30);
  const models::Arrays arrays = ReadAll(stream->get());
  EXPECT_EQ(arrays.at("text").shape, (std::vector<std::int64_t>{30, 16}));
  const std::vector<float> text(arrays.at("text").f32.begin(), arrays.at("text").f32.begin() + 16);
  std::vector<float> first = MeansOf({"word1", "word2"});
  first.resize(16);
  EXPECT_EQ(text, first);
  EXPECT_TRUE(Says(account.notes, "p was not used: poses belong to a style"));
}

TEST(FrontEndTest, PlainTextIsSpreadOverTheRecording) {
  const TempFolder folder;
  const std::string audio = WriteWav(folder, "a.wav", Voice(4, 8000), 8000);
  const std::string words = folder.Write("w.txt", "word1 word2, word3 word4");
  Account account;
  const auto read = ReadWords({.audio = audio, .transcript = words}, &account);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_NEAR(read->words[2].start, 4 * 11 / 21.0, 1e-9);
  EXPECT_EQ(read->words[3].end, 4);
  EXPECT_TRUE(Says(account.notes, "spread over the 4.00 s of the recording"));
  account = {};
  const auto alone = ReadWords({.transcript = words}, &account);
  EXPECT_NEAR(alone->words[3].end, 24 / 15.0, 1e-9);
  EXPECT_TRUE(Says(account.notes, "at 15 characters a second"));
}

TEST(FrontEndTest, BertTakesWordsOnly) {
  const TempFolder folder;
  const std::string audio = WriteWav(folder, "a.wav", Voice(0.5, 8000), 8000);
  auto front_end = FrontEnd::Make(GoldenBert(), "", {});
  ASSERT_TRUE(front_end.ok());
  Account account;
  const auto silent = (*front_end)->Open({.audio = audio}, &account);
  ASSERT_FALSE(silent.ok());
  EXPECT_EQ(silent.status().message(), audio + ": no words, expected a transcript for BERT");
  auto stream =
      (*front_end)->Open({.audio = audio, .transcript = folder.Write("w", "word1")}, &account);
  ASSERT_TRUE(stream.ok()) << stream.status().message();
  EXPECT_EQ(ReadAll(stream->get()).at("ids").i32, std::vector<std::int32_t>{4});
  EXPECT_TRUE(Says(account.notes, "a.wav was not used: the network takes words"));
}

TEST(FrontEndTest, ErrorsNameTheFile) {
  Account account;
  EXPECT_EQ(FrontEnd::Make(GoldenBert(), "none", {}).status().code(), Code::kNotFound);
  const auto front_end = TalkFrontEnd();
  const auto stream = front_end->Open({.transcript = "no/such.txt"}, &account);
  ASSERT_FALSE(stream.ok());
  EXPECT_TRUE(stream.status().message().starts_with("no/such.txt: ")) << stream.status().message();
}

TEST(StagesTest, EveryStageHasItsRows) {
  const TempFolder folder, poses;
  const std::string audio = WriteWav(folder, "a.wav", Voice(2, 16000), 16000);
  const std::string words = folder.Write("w.txt", "0.1 0.5 word1\n0.5 1.0 word2\n1.5 1.9 word3\n");
  const std::string openface =
      folder.Write("f.csv",
                   "frame, timestamp, confidence, success, pose_Rx, AU01_r\n"
                   "1, 0, 0.98, 1, 0.1, 0.5\n2, 0.04, 0.98, 1, 0.2, 0.6\n3, 0.08, 0, 0, 0, 0\n");
  for (int i = 0; i < 50; ++i)
    poses.Write(motion::FrameName(i),
                motion::FrameText({motion::FigureAt(300 + static_cast<float>(i), 200)}));
  FeatureSpec spec = FramesSpec();
  spec.joints = {0, 1, 4};
  Account account;
  const auto arrays = Stages({.audio = audio, .transcript = words, .openpose = poses.path()},
                             openface, spec, &account);
  ASSERT_TRUE(arrays.ok()) << arrays.status().message();
  using Shape = std::vector<std::int64_t>;
  const std::vector<std::pair<const char*, Shape>> want = {{"log_mel", {32, 128}},
                                                           {"pitch", {200}},
                                                           {"pitch_strength", {200}},
                                                           {"jitter", {200}},
                                                           {"shimmer", {200}},
                                                           {"hnr", {200}},
                                                           {"hammarberg", {200}},
                                                           {"word_ms", {3, 2}},
                                                           {"unit_ms", {2, 2}},
                                                           {"word_of_frame", {30}},
                                                           {"body", {50, 104}},
                                                           {"body_confidence", {50, 52}},
                                                           {"body_clean", {30, 104}},
                                                           {"pose", {30, 6}},
                                                           {"openface", {3, 2}},
                                                           {"openface_clean", {3, 2}},
                                                           {"openface_confidence", {3, 2}}};
  for (const auto& [name, shape] : want) {
    ASSERT_EQ(arrays->count(name), 1u) << name;
    EXPECT_EQ(arrays->at(name).shape, shape) << name;
  }
  EXPECT_EQ(arrays->size(), want.size());
  EXPECT_EQ(arrays->at("unit_ms").i32, (std::vector<std::int32_t>{100, 1000, 1500, 1900}));
  const std::vector<std::int32_t>& frames = arrays->at("word_of_frame").i32;
  EXPECT_EQ(frames[0], 0);
  EXPECT_EQ(frames[7], 1);
  EXPECT_EQ(frames[29], 2);
}

TEST(StagesTest, StandAlone) {
  const TempFolder folder;
  Account account;
  const auto empty = Stages({.audio = WriteWav(folder, "e.wav", {}, 8000)}, "", {}, &account);
  ASSERT_FALSE(empty.ok());
  EXPECT_NE(empty.status().message().find("e.wav: has no samples"), std::string::npos);
  const auto silent = Stages({.transcript = folder.Write("w.srt", "")}, "", {}, &account);
  ASSERT_TRUE(silent.ok());
  EXPECT_TRUE(silent->empty());
}

}  // namespace
}  // namespace gestus::features
