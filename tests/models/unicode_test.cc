// Unicode as the tokeniser sees it, for every code point that Python's unicodedata knows.
#include "models/text/unicode.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/models/text_data.h"

namespace gestus::models {
namespace {

std::int32_t Hex(const std::string& text) {
  return static_cast<std::int32_t>(std::stol(text, nullptr, 16));
}

std::string Describe(std::int32_t c) {
  const std::map<Kind, std::string> kinds = {{Kind::kDropped, "dropped"},
                                             {Kind::kSpace, "space"},
                                             {Kind::kIdeograph, "ideograph"},
                                             {Kind::kPunctuation, "punctuation"},
                                             {Kind::kOther, "other"}};
  const std::map<CaseRole, std::string> roles = {
      {CaseRole::kNone, "none"}, {CaseRole::kCased, "cased"}, {CaseRole::kIgnorable, "ignorable"}};
  return kinds.at(KindOf(c)) + " " + roles.at(CaseRoleOf(c)) + " " +
         std::to_string(IsNonspacingMark(c)) + " " + std::to_string(CombiningClass(c));
}

TEST(UnicodeTest, PropertiesAreThoseOfPython) {
  std::int64_t checked = 0;
  for (const auto& row : ReadTable("wordpiece_unicode.tsv")) {
    if (row[0] != "C") continue;
    const std::string want = row[3] + " " + row[4] + " " + row[5] + " " + row[6];
    for (std::int32_t c = Hex(row[1]); c <= Hex(row[2]); ++c, ++checked)
      ASSERT_EQ(Describe(c), want) << "U+" << std::hex << c;
  }
  EXPECT_GT(checked, 280000);
}

TEST(UnicodeTest, LowerCaseAndDecompositionAreThoseOfPython) {
  std::map<std::int32_t, std::string> images;
  std::vector<std::vector<std::string>> rows = ReadTable("wordpiece_unicode.tsv");
  for (const auto& row : rows)
    if (row[0] == "D") images[Hex(row[1])] = row[2];
  EXPECT_GT(images.size(), 3000u);
  for (const auto& row : rows) {
    if (row[0] != "C") continue;
    for (std::int32_t c = Hex(row[1]); c <= Hex(row[2]); ++c) {
      if (0xAC00 <= c && c <= 0xD7A3) continue;
      std::vector<std::int32_t> want;
      if (!images.contains(c)) {
        want = {c};
      } else {
        for (const std::string& image : Split(images.at(c), ' ')) want.push_back(Hex(image));
      }
      const Decomposition got = Decompose(Lower(c));
      ASSERT_EQ(std::vector(got.values.data(), got.values.data() + got.count), want)
          << "U+" << std::hex << c;
    }
  }
}

// The Unicode Standard, 3.12: a syllable is (L * 21 + V) * 28 + T.
TEST(UnicodeTest, HangulDecomposesByItsFormula) {
  for (std::int32_t s = 0; s < 11172; ++s) {
    const Decomposition got = Decompose(0xAC00 + s);
    ASSERT_EQ(got.count, s % 28 == 0 ? 2u : 3u);
    ASSERT_EQ(got.values[0], 0x1100 + s / 28 / 21);
    ASSERT_EQ(got.values[1], 0x1161 + s / 28 % 21);
    ASSERT_EQ(got.values[2], s % 28 == 0 ? 0 : 0x11A7 + s % 28);
  }
}

TEST(UnicodeTest, EveryCodePointSurvivesEncoding) {
  for (std::int32_t c = 0; c < 0x110000; ++c) {
    if (0xD800 <= c && c < 0xE000) continue;
    std::string bytes;
    AppendUtf8(c, &bytes);
    const Decoded got = DecodeUtf8(bytes, 0);
    ASSERT_EQ(got.value, c);
    ASSERT_EQ(got.bytes, bytes.size());
    ASSERT_TRUE(IsUtf8(bytes));
  }
}

TEST(UnicodeTest, WhatIsNotUtf8IsReplacedByteByByte) {
  for (const char* bad : {"\x80", "\xC0\x80", "\xC3", "\xC3(", "\xE4\xB8", "\xED\xA0\x80",
                          "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xFF"}) {
    const Decoded got = DecodeUtf8(bad, 0);
    EXPECT_EQ(got.value, kReplacement);
    EXPECT_EQ(got.bytes, 1u);
    EXPECT_FALSE(IsUtf8(bad));
  }
}

}  // namespace
}  // namespace gestus::models
