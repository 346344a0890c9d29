// Words on frames; words_test.py compares with a transcription of PATS's own rules in Python.
#include "models/words/frames.h"

#include <gtest/gtest.h>

#include <random>

namespace gestus::words {
namespace {

// "0.0 0.1 1.0": word and piece of each frame; "-" without.
std::string Show(const Result<FramePlan>& plan) {
  if (!plan.ok()) return plan.status().message();
  std::string text;
  for (const FramePiece& at : plan->frames) {
    text += text.empty() ? "" : " ";
    text += at.word < 0 ? "-" : std::to_string(at.word) + "." + std::to_string(at.piece);
  }
  return text;
}

TEST(FramesTest, PlacesAsPatsDoes) {
  const std::vector<Word> words = {{"a", 0.1, 0.2}, {"b", 0.2, 0.4}, {"c", 0.5, 0.6}};
  // The first begins at 0, and there are no gaps.
  EXPECT_EQ(Show(PlaceOnFrames(words, {1, 1, 1}, {.frames = 10})),
            "0.0 0.0 0.0 1.0 1.0 1.0 1.0 2.0 2.0 2.0");
  // 4 frames for 3 pieces: 1, 1 and the remainder; 3 frames for 4: 0, 0, 0 and 3.
  EXPECT_EQ(Show(PlaceOnFrames(words, {1, 3, 4}, {.frames = 10})),
            "0.0 0.0 0.0 1.0 1.1 1.2 1.2 2.3 2.3 2.3");
  EXPECT_EQ(Show(PlaceOnFrames(words, {1, 1, 1}, {.start = 0.1, .frames = 7})),
            "0.0 1.0 1.0 1.0 1.0 1.0 2.0");
}

TEST(FramesTest, LeavesOutWhatIsOutside) {
  const std::vector<Word> words = {{"a", 0, 0.9}, {"b", 0.9, 1.1}, {"c", 1.25, 2.1}, {"d", 2.1, 3}};
  const auto plan = PlaceOnFrames(words, {1, 1, 1, 1}, {.start = 1, .frames = 5, .rate = 5});
  EXPECT_EQ(Show(plan), "1.0 2.0 2.0 2.0 2.0");
  EXPECT_EQ(plan->notes, std::vector<std::string>{"2 words outside of 1.00 to 2.00 s left out"});
  const auto by_end =
      PlaceOnFrames(words, {1, 1, 1, 1}, {.start = 1, .frames = 5, .rate = 5, .by_end = true});
  EXPECT_EQ(Show(by_end), "1.0 1.0 1.0 1.0 1.0");
}

TEST(FramesTest, TakesNoWords) {
  EXPECT_EQ(Show(PlaceOnFrames({}, {}, {.frames = 3})), "- - -");
  EXPECT_EQ(Show(PlaceOnFrames({{"a", 0, 1}}, {1}, {.frames = 0})), "");
  const auto plan = PlaceOnFrames({{"a", 0, 1}, {"b", 1, 2}}, {0, 2}, {.frames = 4, .rate = 2});
  EXPECT_EQ(Show(plan), "1.0 1.0 1.1 1.1");
  EXPECT_EQ(plan->notes, std::vector<std::string>{"1 word without any token left out"});
  // A word whose length is not known.
  EXPECT_EQ(Show(PlaceOnFrames({{"a", 0, 0}}, {1}, {.frames = 2})), "0.0 0.0");
}

TEST(FramesTest, SaysWhatMakesNoSense) {
  const std::vector<Word> words = {{"a", 0, 1}};
  EXPECT_EQ(Show(PlaceOnFrames(words, {}, {.frames = 1})),
            "there are numbers of pieces for 0 words, expected 1");
  EXPECT_EQ(Show(PlaceOnFrames(words, {1}, {.frames = 1, .rate = 0})),
            "the interval begins at 0 s and has 0 frames a second, expected finite numbers and a "
            "rate above 0");
  EXPECT_EQ(Show(PlaceOnFrames(words, {1}, {.frames = std::size_t{1} << 40})),
            "1,099,511,627,776 frames for 1 word, expected at most 268,435,456 frames");
}

// Whatever the words are, every frame has one as soon as there is any, and they come in order.
TEST(FramesTest, CoversEveryFrame) {
  std::mt19937 random(20200821);
  for (int round = 0; round < 5000; ++round) {
    std::vector<Word> words(random() % 12);
    std::vector<std::size_t> pieces(words.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
      words[i].start = static_cast<double>(random() % 400) / 100 - 0.5;
      words[i].end = words[i].start + static_cast<double>(random() % 100) / 100;
      pieces[i] = random() % 5;
    }
    const std::size_t frames = random() % 50;
    const auto plan = PlaceOnFrames(words, pieces, {.start = 0.25, .frames = frames});
    ASSERT_TRUE(plan.ok());
    ASSERT_EQ(plan->frames.size(), frames);
    FramePiece before = {0, 0};
    for (const FramePiece& at : plan->frames) {
      ASSERT_EQ(at.word < 0, plan->words.empty());
      if (at.word < 0) continue;
      ASSERT_LT(static_cast<std::size_t>(at.piece), pieces[static_cast<std::size_t>(at.word)]);
      ASSERT_TRUE(at.word > before.word || (at.word == before.word && at.piece >= before.piece));
      before = at;
    }
  }
}

}  // namespace
}  // namespace gestus::words
