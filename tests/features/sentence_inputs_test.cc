#include "models/features/sentence_inputs.h"

#include <gtest/gtest.h>

#include "tests/features/recordings.h"

namespace gestus::features {
namespace {

// Of the golden's vocabulary "word0" is token 3 and 1 is unknown.
models::WordPiece Tokeniser() {
  const auto file = GoldenBert();
  auto words = ReadTokeniser(*file, *file->FindNetwork(""));
  EXPECT_TRUE(words.ok());
  return *std::move(words);
}

words::Transcript ThreeSentences() {
  words::Transcript transcript;
  transcript.words = {{"word1", 0.5, 1},    {"word2.", 1, 1.5},    {"\u2026", 1.6, 1.7},
                      {"word3", 2, 2.25},   {"word4,", 2.25, 2.5}, {"word5?", 2.5, 3},
                      {"word6!", 3.5, 3.75}};
  return transcript;
}

FeatureSpec Sentences(bool classifies, std::int64_t positions = 12) {
  FeatureSpec spec;
  spec.layout = Layout::kSentences;
  spec.classifies = classifies;
  spec.positions = positions;
  return spec;
}

TEST(SentenceInputsTest, BertGetsTheWordsAsOneSequence) {
  Account account;
  auto inputs =
      SentenceInputs::Open(Sentences(false), ThreeSentences(), "t.txt", Tokeniser(), &account);
  ASSERT_TRUE(inputs.ok()) << inputs.status().message();
  EXPECT_EQ((*inputs)->total(), 1);
  EXPECT_EQ((*inputs)->Beside().at("times_ms").i32, (std::vector<std::int32_t>{500, 3750}));
  const models::Arrays arrays = ReadAll(inputs->get());
  EXPECT_EQ(arrays.at("ids").shape, (std::vector<std::int64_t>{1, 6}));  // without punctuation
  EXPECT_EQ(arrays.at("ids").i32, (std::vector<std::int32_t>{4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(arrays.at("ids").dtype, DType::kI32);
  EXPECT_TRUE(Says(account.used, "t.txt: , 7 words -> ids, 6 pieces"));
}

TEST(SentenceInputsTest, TheClassifierGetsEachSentence) {
  Account account;
  auto inputs =
      SentenceInputs::Open(Sentences(true), ThreeSentences(), "t.txt", Tokeniser(), &account);
  ASSERT_TRUE(inputs.ok()) << inputs.status().message();
  EXPECT_EQ((*inputs)->total(), 4);
  EXPECT_EQ((*inputs)->unit(), 1);
  const auto next = (*inputs)->Next(4);
  ASSERT_TRUE(next.ok());
  // Signs are pieces here, unknown ones, and rows end in zeros.
  EXPECT_EQ(next->at("ids").shape, (std::vector<std::int64_t>{4, 5}));
  EXPECT_EQ(next->at("ids").i32, (std::vector<std::int32_t>{4, 5, 1, 0, 0, 1, 0, 0, 0, 0,
                                                            6, 7, 1, 8, 1, 9, 1, 0, 0, 0}));
  EXPECT_EQ((*inputs)->Beside().at("times_ms").i32,
            (std::vector<std::int32_t>{500, 1500, 1600, 1700, 2000, 3000, 3500, 3750}));
  EXPECT_TRUE((*inputs)->Next(4)->empty());
}

TEST(SentenceInputsTest, LongSentencesAreShortened) {
  Account account;
  auto inputs =
      SentenceInputs::Open(Sentences(true, 6), ThreeSentences(), "t.txt", Tokeniser(), &account);
  ASSERT_TRUE(inputs.ok());
  EXPECT_EQ(ReadAll(inputs->get()).at("ids").shape, (std::vector<std::int64_t>{4, 4}));
  EXPECT_TRUE(Says(account.notes, "1 sentence had more than 4 pieces"));
  account = {};
  inputs =
      SentenceInputs::Open(Sentences(false, 6), ThreeSentences(), "t.txt", Tokeniser(), &account);
  EXPECT_EQ(ReadAll(inputs->get()).at("ids").shape[1], 6);  // the network cuts it into chunks
  EXPECT_TRUE(account.notes.empty());
}

TEST(SentenceInputsTest, NoWordsAreAnError) {
  Account account;
  for (const bool classifies : {true, false}) {
    const auto inputs =
        SentenceInputs::Open(Sentences(classifies), {}, "t.txt", Tokeniser(), &account);
    ASSERT_FALSE(inputs.ok());
    EXPECT_EQ(inputs.status().message(), "t.txt: has no words, expected some");
  }
}

}  // namespace
}  // namespace gestus::features
