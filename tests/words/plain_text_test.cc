// Text without times.
#include <gtest/gtest.h>

#include <string>

#include "tests/words/samples.h"

namespace gestus::words {
namespace {

Result<Transcript> Read(const std::string& bytes) {
  return ParseTranscript(bytes, "t", {.plain_text = true});
}

std::string ShowText(const std::string& bytes) {
  const Result<Transcript> transcript = Read(bytes);
  return transcript.ok() ? Show(transcript->words) : transcript.status().message();
}

TEST(PlainTextTest, WordsFollowOneAnotherAtFifteenCharactersASecond) {
  const Result<Transcript> read = Read("Hello there, \u2014 you!\n");
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->format, "plain text");
  EXPECT_TRUE(read->plain_text);
  // 19 characters, of which the 15 of words share the time.
  EXPECT_EQ(Show(read->words), "Hello 0.00-0.42*, there, 0.42-0.93*, you! 0.93-1.27*");
  ASSERT_EQ(read->notes.size(), 1u);
  EXPECT_NE(read->notes[0].find("plain text has no times"), std::string::npos);
}

TEST(PlainTextTest, ARecordingGivesThePace) {
  Result<Transcript> read = Read("ab cd\nefgh");
  ASSERT_TRUE(read.ok());
  SpreadOver(8, &*read);
  EXPECT_EQ(Show(read->words), "ab 0.00-2.00*, cd 2.00-4.00*, efgh 4.00-8.00*");
  ASSERT_EQ(read->notes.size(), 1u);
  EXPECT_NE(read->notes[0].find("over the 8.00 s of the recording"), std::string::npos)
      << read->notes[0];
  Result<Transcript> timed = Read("0.5 1 ab\n");
  ASSERT_TRUE(timed.ok());
  SpreadOver(8, &*timed);
  EXPECT_EQ(Show(timed->words), "ab 0.50-1.00");
}

TEST(PlainTextTest, OneWordAndOtherScripts) {
  EXPECT_EQ(ShowText("Hi"), "Hi 0.00-0.13*");
  EXPECT_EQ(ShowText("\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d \xf0\x9f\x91\x8b"),
            "\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d 0.00-0.32*, \xf0\x9f\x91\x8b 0.32-0.40*");
  EXPECT_EQ(ShowText("I have 2 cats and a dog"),
            "I 0.00-0.09*, have 0.09-0.45*, 2 0.45-0.54*, cats 0.54-0.90*, and 0.90-1.17*, a "
            "1.17-1.26*, dog 1.26-1.53*");
}

TEST(PlainTextTest, OnlyWhereItIsAskedFor) {
  EXPECT_FALSE(ParseTranscript("Hello there", "t").ok());
  EXPECT_FALSE(LooksTimed("Hello there, how are you"));
  EXPECT_FALSE(LooksTimed(""));
  EXPECT_TRUE(LooksTimed("WEBVTT\n\n"));
  EXPECT_TRUE(LooksTimed("{\"segments\": ["));
}

TEST(PlainTextTest, WhatIsNoProseIsRefused) {
  for (const std::string bytes : {"caf\xe9 au lait", "a\x01 b", "<html>hello there</html>",
                                  "deep 0.5 learning 0.7 x", "... -- !", "0.5", "{\"a\": \"b\"}"}) {
    EXPECT_FALSE(Read(bytes).ok()) << bytes;
  }
}

TEST(PlainTextTest, DescriptionsAreNoWords) {
  EXPECT_EQ(ShowText("[Music] hi there"), "hi 0.53-0.69*, there 0.69-1.07*");
  const Result<Transcript> none = Read("[Music playing]");
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->words.empty());
}

}  // namespace
}  // namespace gestus::words
