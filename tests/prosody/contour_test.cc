// f0 of words, worked out by hand.
#include "models/prosody/contour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gestus::prosody {
namespace {

using Values = std::vector<float>;

WordContours Contours(const Values& f0, const std::vector<WordSpan>& words,
                      const ContourOptions& options) {
  auto made = ContoursOfWords(f0.data(), f0.size(), 1, words, options);
  EXPECT_TRUE(made.ok()) << made.status().message();
  return *std::move(made);
}

Values Word(const Values& f0, double start, double end, const ContourOptions& options) {
  return Contours(f0, {{start, end}}, options).hz;
}

TEST(ContourTest, FillsBetweenVoicedValues) {
  const Values f0 = {0, 100, 0, 0, 130, 0, 120, 0};
  EXPECT_EQ(Word(f0, 0, 0.08, {.values = 10}),
            (Values{100, 100, 110, 120, 130, 125, 120, 120, 0, 0}));
}

TEST(ContourTest, OneVoicedValueFillsTheWord) {
  for (const ContourEnds ends : {ContourEnds::kNearest, ContourEnds::kLinear})
    EXPECT_EQ(Word({0, 0, 200, 0}, 0, 0.04, {.values = 4, .ends = ends}),
              (Values{200, 200, 200, 200}));
}

TEST(ContourTest, ExtendsTheLineWithinTheRange) {
  const ContourOptions linear{.values = 7, .ends = ContourEnds::kLinear};
  EXPECT_EQ(Word({0, 0, 100, 0, 140, 0, 0}, 0, 0.07, linear),
            (Values{60, 80, 100, 120, 140, 160, 180}));
  EXPECT_EQ(Word({0, 0, 100, 400, 0, 0, 0}, 0, 0.07, linear),
            (Values{50, 50, 100, 400, 550, 550, 550}));
  // Each end by the two voiced values nearest to it.
  EXPECT_EQ(Word({0, 100, 110, 300, 290, 0, 0}, 0, 0.07, linear),
            (Values{90, 100, 110, 300, 290, 280, 270}));
}

TEST(ContourTest, KeepsWordsApart) {
  const Values f0 = {100, 0, 0, 0, 0, 200};
  const WordContours words = Contours(f0, {{0, 0.03}, {0.03, 0.06}, {0.01, 0.05}}, {.values = 4});
  EXPECT_EQ(words.hz, (Values{100, 100, 100, 0, 200, 200, 200, 0, 0, 0, 0, 0}));
  EXPECT_EQ(words.count, (std::vector<std::size_t>{3, 3, 4}));
  EXPECT_EQ(words.notes,
            std::vector<std::string>{"1 of 3 words have no voiced frame; their f0 is 0"});
}

TEST(ContourTest, CutsLongWordsAfterFillingThem) {
  // What lies behind the cut still ends the line that leads there.
  const Values f0 = {100, 0, 0, 0, 0, 150, 90};
  const WordContours words = Contours(f0, {{0, 0.07}}, {.values = 3});
  EXPECT_EQ(words.hz, (Values{100, 110, 120}));
  EXPECT_EQ(words.notes,
            std::vector<std::string>{"1 of 1 word last longer than 3 f0 values and were cut"});
  EXPECT_EQ(Word({0, 0, 0, 0, 80}, 0, 0.05, {.values = 2}), (Values{80, 80}));
  EXPECT_EQ(Word({0, 0, 0, 100, 110}, 0, 0.05, {.values = 2, .ends = ContourEnds::kLinear}),
            (Values{70, 80}));
}

TEST(ContourTest, TimesAreDecimals) {
  Values f0(400);
  for (std::size_t j = 0; j < f0.size(); ++j) f0[j] = 100 + static_cast<float>(j);
  for (std::size_t j = 0; j + 3 < f0.size(); ++j) {
    const double start = static_cast<double>(j) / 100, end = static_cast<double>(j + 3) / 100;
    EXPECT_EQ(Word(f0, start, end, {.values = 3}), (Values{f0[j], f0[j + 1], f0[j + 2]})) << j;
  }
  // Between two rows the later one is the first.
  EXPECT_EQ(Word(f0, 0.101, 0.125, {.values = 3}), (Values{111, 112, 0}));
}

TEST(ContourTest, WordsAnywhere) {
  const Values f0 = {100, 110, 120};
  const WordContours words =
      Contours(f0, {{0.02, 9}, {5, 6}, {0.01, 0.01}, {1e300, 1e301}}, {.values = 2});
  EXPECT_EQ(words.hz, (Values{120, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(words.notes,
            std::vector<std::string>{"2 of 4 words begin behind the end of the recording"});
  EXPECT_TRUE(Contours({}, {{0, 1}}, {.values = 2}).hz == Values(2));
  EXPECT_TRUE(Contours(f0, {}, {}).hz.empty());
}

TEST(ContourTest, ReadsOneColumnOfRows) {
  const Values rows = {100, 0.9f, 0, 0.1f, 120, 0.8f};
  const auto words = ContoursOfWords(rows.data(), 3, 2, {{0, 0.03}}, {.values = 3});
  ASSERT_TRUE(words.ok());
  EXPECT_EQ(words->hz, (Values{100, 110, 120}));
}

TEST(ContourTest, WhatIsNoPitchIsUnvoiced) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(Word({nan, 100, -5, inf, 130}, 0, 0.05, {.values = 5}),
            (Values{100, 100, 110, 120, 130}));
}

// Each word costs what it gets: ten thousand words over an hour of one voiced row.
TEST(ContourTest, ManyLongWords) {
  Values f0(360000);
  f0.back() = 100;
  const WordContours words = Contours(f0, std::vector<WordSpan>(10000, {0, 3600}), {.values = 100});
  for (const float hz : words.hz) ASSERT_EQ(hz, 100.0f);
}

TEST(ContourTest, SaysWhatIsWrong) {
  const auto error = [](const std::vector<WordSpan>& words, const ContourOptions& options = {}) {
    const float f0 = 0;
    return ContoursOfWords(&f0, 1, 1, words, options).status().message();
  };
  EXPECT_EQ(error({{0, 1}, {1.2, 1}}), "word 2: from 1.2 to 1 s, expected 0 <= start <= end");
  EXPECT_EQ(error({{-1, 1}}), "word 1: from -1 to 1 s, expected 0 <= start <= end");
  EXPECT_EQ(error({{0, NAN}}), "word 1: from 0 to nan s, expected 0 <= start <= end");
  EXPECT_EQ(error({{0, INFINITY}}), "word 1: from 0 to inf s, expected 0 <= start <= end");
  EXPECT_EQ(error({}, {.hop_seconds = 0}), "hop_seconds is 0, expected more than 0");
  EXPECT_EQ(error({}, {.values = 0}), "values is 0, expected 1 to 65,536");
  EXPECT_EQ(error({}, {.min_hz = 500, .max_hz = 50}),
            "max_hz is 50, expected more than min_hz, 500");
}

}  // namespace
}  // namespace gestus::prosody
