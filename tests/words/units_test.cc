// Inter-pausal units and sentences.
#include "models/words/units.h"

#include <gtest/gtest.h>

#include <random>

#include "models/io/text.h"

namespace gestus::words {
namespace {

// Words of the given lengths in tenths of a second, each behind the silence before it.
std::vector<Word> MakeWords(const std::vector<std::pair<int, int>>& silence_and_length) {
  std::vector<Word> words;
  int at = 0;
  for (const auto& [silence, length] : silence_and_length) {
    at += silence;
    words.push_back({"w", at / 10.0, (at + length) / 10.0});
    at += length;
  }
  return words;
}

// "0 , 1 | 2": the items of units.
std::string Show(const std::vector<Unit>& units) {
  std::string text;
  for (const Unit& unit : units) {
    text += text.empty() ? "" : " |";
    for (const UnitItem& item : unit.items) {
      text += (text.empty() ? "" : " ") + (item.is_comma() ? "," : std::to_string(item.word));
    }
  }
  return text;
}

TEST(UnitsTest, SplitsAtLongSilences) {
  // 0.2 s exactly, though 0.8 - 0.6 is more than 0.2 in binary, and 0.3 s.
  const std::vector<Word> words = MakeWords({{5, 1}, {2, 3}, {0, 1}, {3, 4}, {1, 1}});
  const auto units = MakeUnits(words);
  ASSERT_TRUE(units.ok());
  EXPECT_EQ(Show(*units), "0 , 1 2 | 3 , 4");
  ASSERT_EQ(units->size(), 2u);
  const Unit& unit = (*units)[0];
  EXPECT_EQ(unit.first, 0u);
  EXPECT_EQ(unit.count, 3u);
  EXPECT_EQ(unit.start, 0.5);
  EXPECT_EQ(unit.end, 1.2);
  EXPECT_EQ(unit.items[1].start, 0.6);
  EXPECT_EQ(unit.items[1].end, 0.8);
  EXPECT_EQ(Show(*MakeUnits(words, {.commas = false})), "0 1 2 | 3 4");
  EXPECT_EQ(Show(*MakeUnits(words, {.pause = 0.35})), "0 , 1 2 , 3 , 4");
  EXPECT_EQ(Show(*MakeUnits(words, {.pause = 0})), "0 | 1 2 | 3 | 4");
  EXPECT_EQ(Show(*MakeUnits(words, {.shortest_silence = 0.15})), "0 , 1 2 | 3 4");
}

TEST(UnitsTest, CutsWindows) {
  const std::vector<Word> words = MakeWords({{0, 1}, {0, 1}, {1, 1}, {1, 1}, {0, 1}, {0, 1}});
  EXPECT_EQ(Show(*MakeUnits(words, {.max_items = 0})), "0 1 , 2 , 3 4 5");
  EXPECT_EQ(Show(*MakeUnits(words, {.max_items = 4})), "0 1 , 2 | 3 4 5");
  // A window neither begins nor ends with a silence.
  EXPECT_EQ(Show(*MakeUnits(words, {.max_items = 3})), "0 1 | 2 , 3 | 4 5");
  EXPECT_EQ(Show(*MakeUnits(words, {.max_items = 1})), "0 | 1 | 2 | 3 | 4 | 5");
  EXPECT_EQ(Show(*MakeUnits(words, {.commas = false, .max_items = 4})), "0 1 2 3 | 4 5");
}

TEST(UnitsTest, TakesNothing) {
  EXPECT_TRUE(MakeUnits({})->empty());
  EXPECT_TRUE(MakeSentences({}).empty());
  EXPECT_EQ(MakeUnits({}, {.pause = -1}).status().message(),
            "pause is -1.000 s and the shortest silence 0.01000 s, but neither may be negative");
}

// Every word is in one unit, in order, and the limits hold.
TEST(UnitsTest, LosesNoWord) {
  std::mt19937 random(20220113);
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::pair<int, int>> lengths(random() % 40);
    for (auto& [silence, length] : lengths) {
      silence = random() % 2 == 0 ? 0 : static_cast<int>(random() % 5);
      length = static_cast<int>(random() % 6);
    }
    const std::vector<Word> words = MakeWords(lengths);
    const std::size_t limit = random() % 12;
    const auto units = MakeUnits(words, {.max_items = limit});
    ASSERT_TRUE(units.ok());
    std::size_t next = 0;
    for (const Unit& unit : *units) {
      ASSERT_EQ(unit.first, next);
      ASSERT_FALSE(unit.items.empty());
      ASSERT_TRUE(limit == 0 || unit.items.size() <= limit);
      ASSERT_FALSE(unit.items.front().is_comma() || unit.items.back().is_comma());
      ASSERT_EQ(unit.start, words[next].start);
      for (const UnitItem& item : unit.items) {
        if (item.is_comma()) {
          ASSERT_GT(item.end, item.start);
        } else {
          ASSERT_EQ(item.word, next++);
        }
      }
      ASSERT_EQ(unit.first + unit.count, next);
      ASSERT_EQ(unit.end, words[next - 1].end);
    }
    ASSERT_EQ(next, words.size());
  }
}

std::string ShowSentences(const std::vector<std::string>& texts, std::size_t pause_before,
                          const SentenceOptions& options = {}) {
  std::vector<Word> words;
  double at = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (i == pause_before) at += 0.5;
    words.push_back({texts[i], at, at + 0.25});
    at += 0.25;
  }
  std::string text;
  std::size_t next = 0;
  for (const Sentence& sentence : MakeSentences(words, options)) {
    EXPECT_EQ(sentence.first, next);
    next += sentence.count;
    EXPECT_EQ(sentence.start, words[sentence.first].start);
    EXPECT_EQ(sentence.end, words[next - 1].end);
    text += (text.empty() ? "" : "/") + sentence.text;
  }
  EXPECT_EQ(next, texts.size());
  return text;
}

TEST(SentencesTest, EndWherePunctuationDoes) {
  EXPECT_EQ(ShowSentences({"Who", "is", "Dr.", "J.", "Smith?", "He,", "I.", "Ok"}, 1),
            "Who is Dr. J. Smith?/He, I./Ok");
  EXPECT_EQ(ShowSentences({"\"Yes!\"", "no\u3002", "so\u2026)", "3.5", "end"}, 99),
            "\"Yes!\"/no\u3002/so\u2026)/3.5 end");
}

TEST(SentencesTest, EndAtPausesWithoutPunctuation) {
  EXPECT_EQ(ShowSentences({"so", "it", "goes", "on"}, 2), "so it/goes on");
  EXPECT_EQ(ShowSentences({"so", "it", "goes", "on."}, 2), "so it goes on.");
  EXPECT_EQ(ShowSentences({"so", "it", "goes", "on."}, 2, {.max_words = 3}), "so it/goes on.");
  EXPECT_EQ(ShowSentences({"so", "it", "goes", "on."}, 99, {.max_words = 3}), "so it goes on.");
}

}  // namespace
}  // namespace gestus::words
