// WordPiece against a transcription of the rules in Python
// (tests/models/wordpiece_expectations.py), and on bytes that are no text.
#include "models/text/wordpiece.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/models/text_data.h"

namespace gestus::models {
namespace {

WordPiece TestWords(const WordPieceOptions& options = {}) {
  auto made = WordPiece::Make(ReadTextData("wordpiece_vocab.txt"), options);
  EXPECT_TRUE(made.ok()) << made.status().message();
  return *std::move(made);
}

WordPiece SmallWords(const WordPieceOptions& options = {}) {
  return *WordPiece::Make("[UNK]\n[CLS]\n[SEP]\na\n##a\nb\n.", options);
}

std::string FromHex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

std::string Describe(const std::vector<Token>& tokens) {
  std::string text;
  for (const Token& t : tokens)
    text += (text.empty() ? "" : " ") + std::to_string(t.id) + ":" + std::to_string(t.begin) + ":" +
            std::to_string(t.end);
  return text;
}

TEST(WordPieceTest, GivesWhatTheTranscriptionGives) {
  const WordPiece lower = TestWords(), cased = TestWords({.lower_case = false});
  const auto rows = ReadTable("wordpiece_cases.tsv");
  EXPECT_GT(rows.size(), 350u);
  for (const auto& row : rows) {
    const WordPiece& words = row[1] == "lower" ? lower : cased;
    EXPECT_EQ(Describe(words.Tokenise(FromHex(row[2]))), row[3]) << row[0] << ", " << row[1];
  }
}

TEST(WordPieceTest, CountsTheCharactersOfAWord) {
  const WordPiece words = SmallWords({.max_word_chars = 3});
  EXPECT_EQ(Describe(words.Tokenise("aaa aaaa")), "3:0:1 4:1:2 4:2:3 0:4:8");
}

TEST(WordPieceTest, TimeGrowsWithTheLength) {
  const WordPiece words = TestWords();
  const std::size_t n = 1 << 20;
  EXPECT_EQ(words.Tokenise(std::string(n, 'a')).size(), 1u);
  EXPECT_EQ(words.Tokenise(std::string(n, '.')).size(), n);
  // Sigmas that look for a letter behind many apostrophes, and marks to be sorted.
  std::string sigmas = "a", marks = "a";
  for (std::size_t i = 0; i < n / 4; ++i) {
    sigmas += i % 1000 == 0 ? "\u03A3" : "'";
    marks += i % 2 == 0 ? "\u302F" : "\U0001D165";
  }
  EXPECT_GT(words.Tokenise(sigmas).size(), n / 8);
  EXPECT_EQ(Describe(words.Tokenise(marks)), "1:0:" + std::to_string(marks.size()));
}

TEST(WordPieceTest, FramesASentence) {
  const WordPiece words = SmallWords();
  const auto whole = words.Frame("aa b.", 6);
  ASSERT_TRUE(whole.ok());
  EXPECT_EQ(Describe(whole->tokens), "1:0:0 3:0:1 4:1:2 5:3:4 6:4:5 2:5:5");
  EXPECT_EQ(whole->left_out, 0u);
  const auto cut = words.Frame("aa b.", 5);
  ASSERT_TRUE(cut.ok());
  EXPECT_EQ(Describe(cut->tokens), "1:0:0 3:0:1 4:1:2 5:3:4 2:4:4");
  EXPECT_EQ(cut->left_out, 1u);
  const auto nothing = words.Frame("aa b.", 2);
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(Describe(nothing->tokens), "1:0:0 2:0:0");
  EXPECT_EQ(nothing->left_out, 4u);
  EXPECT_EQ(words.Frame("aa b.", 1).status().message(),
            "a sentence of at most 1 tokens has no room for [CLS] and [SEP]");
}

TEST(WordPieceTest, SaysWhatIsWrong) {
  const auto error = [](const char* vocabulary, const WordPieceOptions& options = {}) {
    return WordPiece::Make(vocabulary, options).status().message();
  };
  EXPECT_EQ(error("a\n[CLS]\n[SEP]"),
            "vocabulary: none of its 3 tokens is [UNK], which BERT needs");
  EXPECT_EQ(error("[UNK]\n[SEP]\n"), "vocabulary: none of its 2 tokens is [CLS], which BERT needs");
  EXPECT_EQ(error("[UNK]\n[CLS]\n[sep]"),
            "vocabulary: none of its 3 tokens is [SEP], which BERT needs");
  EXPECT_EQ(error(""), "vocabulary: none of its 0 tokens is [UNK], which BERT needs");
  EXPECT_EQ(error("[UNK]\n[UNK]\n"),
            "vocabulary: line 2 repeats the token of line 1, but each must be there once");
  EXPECT_EQ(error("[UNK]\n[CLS]\n[SEP]", {.max_word_chars = 0}),
            "max_word_chars is 0, but must be at least 1");
}

void ExpectOffsetsInOrder(const std::vector<Token>& tokens, std::string_view text) {
  std::size_t begin = 0, end = 0;
  for (const Token& t : tokens) {
    ASSERT_LT(t.begin, t.end);
    ASSERT_LE(t.end, text.size());
    ASSERT_GE(t.begin, begin);
    ASSERT_GE(t.end, end);
    begin = t.begin;
    end = t.end;
  }
}

// Half of the bytes are drawn from the characters of the vocabulary, so that pieces are found.
TEST(WordPieceTest, TakesAnyBytes) {
  const WordPiece words[] = {TestWords(), TestWords({.lower_case = false}),
                             TestWords({.max_word_chars = 2})};
  const std::string known = ReadTextData("wordpiece_vocab.txt");
  std::mt19937 random(20190524);
  std::size_t found = 0;
  for (int i = 0; i < 100000; ++i) {
    std::string text;
    const std::size_t length = random() % 64;
    while (text.size() < length) {
      if (random() % 2 == 0)
        text += static_cast<char>(random());
      else
        text += known.substr(random() % known.size(), 1 + random() % 4);
    }
    const std::vector<Token> tokens = words[i % 3].Tokenise(text);
    ASSERT_NO_FATAL_FAILURE(ExpectOffsetsInOrder(tokens, text)) << "string " << i;
    found += tokens.size();
  }
  EXPECT_GT(found, 1000000u);
}

TEST(WordPieceTest, TakesAnyCut) {
  const WordPiece words = TestWords();
  const std::string text = "De\u0301ep \u5B66\u4E60 \U0001F44D\u200D\U0001F469 \u039F\u03A3\u0301.";
  for (std::size_t begin = 0; begin <= text.size(); ++begin)
    for (std::size_t size = 0; begin + size <= text.size(); ++size) {
      // Exactly as large as the text, so that a sanitizer sees a byte read past its end.
      const std::vector<char> part(text.data() + begin, text.data() + begin + size);
      const std::string_view view(part.data(), part.size());
      ASSERT_NO_FATAL_FAILURE(ExpectOffsetsInOrder(words.Tokenise(view), view));
    }
}

}  // namespace
}  // namespace gestus::models
