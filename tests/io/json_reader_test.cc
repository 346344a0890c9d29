#include "models/io/json_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace gestus {
namespace {

TEST(ParseJsonTest, ReadsDocuments) {
  const Result<Json> json = ParseJson("\xef\xbb\xbf{\"words\": [{\"start\": 0.5}]}");
  ASSERT_TRUE(json.ok()) << json.status().message();
  const Json* words = Member(*json, "words");
  ASSERT_NE(words, nullptr);
  EXPECT_EQ(words->at(0)["start"], 0.5);
  EXPECT_EQ(Member(*json, "word"), nullptr);
  EXPECT_EQ(Member(*words, "start"), nullptr);
}

TEST(ParseJsonTest, RefusesWhatIsNone) {
  for (const std::string text :
       {"", "{", "[1,]", "{\"a\": nan}", "[1] 2", "\"\xff\"", "\xef\xbb", "[1e999]"}) {
    const Result<Json> json = ParseJson(text);
    ASSERT_FALSE(json.ok()) << text;
    EXPECT_NE(json.status().message().find("expected a JSON document"), std::string::npos) << text;
  }
  const Result<Json> deep = ParseJson(std::string(1000000, '['));
  ASSERT_FALSE(deep.ok());
  EXPECT_EQ(deep.status().message(), "nests more than 64 levels deep, expected a JSON document");
}

}  // namespace
}  // namespace gestus
