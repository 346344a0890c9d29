// Vocabularies: lines become ids, bad files become one sentence, the longest piece is found.
#include "models/text/vocabulary.h"

#include <gtest/gtest.h>

namespace gestus::models {
namespace {

std::string ErrorOf(std::string bytes) {
  const auto made = Vocabulary::Make(std::move(bytes));
  return made.ok() ? "none" : made.status().message();
}

TEST(VocabularyTest, LinesAreIds) {
  for (const char* bytes : {"a\nb c\n#", "a\nb c\n#\n", "a\r\nb c\r\n#\r\n", "a\r\nb c\r\n#"}) {
    const auto made = Vocabulary::Make(bytes);
    ASSERT_TRUE(made.ok()) << made.status().message();
    ASSERT_EQ(made->size(), 3);
    EXPECT_EQ(made->token(1), "b c");
    EXPECT_EQ(made->Find("#"), 2);
    EXPECT_EQ(made->Find("b"), -1);
    EXPECT_EQ(made->Find("x"), -1);
  }
}

TEST(VocabularyTest, BadFilesAreNamedByTheirLine) {
  EXPECT_EQ(ErrorOf("a\n\nb\n"), "vocabulary: line 2 is empty, but each must hold a token");
  EXPECT_EQ(ErrorOf("a\nb\n\n"), "vocabulary: line 3 is empty, but each must hold a token");
  EXPECT_EQ(ErrorOf("a\r\n\r\n"), "vocabulary: line 2 is empty, but each must hold a token");
  EXPECT_EQ(ErrorOf("a\nb\xC3\n"), "vocabulary: line 2 is not UTF-8");
  EXPECT_EQ(ErrorOf("x\na\nb\na\n"),
            "vocabulary: line 4 repeats the token of line 2, but each must be there once");
  EXPECT_EQ(ErrorOf(std::string(Vocabulary::kMaxBytes + 1, 'a')),
            "vocabulary: 16777217 bytes are more than the 16777216 allowed");
}

TEST(VocabularyTest, FindsTheLongestPiece) {
  const auto made = Vocabulary::Make("a\nab\nabcd\n##a\n##\n##\xC3\xA9\n\xC3\xA9\xC3\xA9");
  ASSERT_TRUE(made.ok());
  const auto start = [&](std::string_view text) { return made->LongestStart(text); };
  EXPECT_EQ(start("abcx").id, 1);
  EXPECT_EQ(start("abcx").bytes, 2u);
  EXPECT_EQ(start("abcde").id, 2);
  EXPECT_EQ(start("abc").id, 1);
  EXPECT_EQ(start("b").id, -1);
  EXPECT_EQ(start("").id, -1);
  EXPECT_EQ(start("\xC3\xA9").id, -1);
  EXPECT_EQ(made->LongestContinuation("ab").id, 3);
  EXPECT_EQ(made->LongestContinuation("ab").bytes, 1u);
  EXPECT_EQ(made->LongestContinuation("\xC3\xA9").bytes, 2u);
  EXPECT_EQ(made->LongestContinuation("b").id, -1);
}

TEST(VocabularyTest, AnEmptyOneFindsNothing) {
  const auto made = Vocabulary::Make("");
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(made->size(), 0);
  EXPECT_EQ(made->LongestStart("a").id, -1);
  EXPECT_EQ(made->LongestContinuation("a").id, -1);
}

}  // namespace
}  // namespace gestus::models
