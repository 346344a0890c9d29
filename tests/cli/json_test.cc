// JSON that every parser takes, whatever a file put into names and notes.
#include "models/cli/json.h"

#include <gtest/gtest.h>

#include <limits>

namespace gestus::cli {
namespace {

TEST(Json, NestsAndSeparates) {
  JsonWriter json;
  json.BeginObject().Member("a", 1).Key("b").BeginArray().Value("x").Value(true).EndArray();
  json.Key("c").BeginObject().EndObject().Member("d", std::vector<std::int64_t>{-1, 2}).EndObject();
  EXPECT_EQ(json.text(), R"({
  "a": 1,
  "b": [
    "x",
    true
  ],
  "c": {},
  "d": [
    -1,
    2
  ]
}
)");
}

TEST(Json, StringsAreEscaped) {
  JsonWriter json;
  json.BeginArray().Value("a\"b\\c\nd\x1b\xff").EndArray();
  EXPECT_EQ(json.text(), "[\n  \"a\\\"b\\\\c\\nd\\\\x1b\\\\xff\"\n]\n");
}

TEST(Json, NumbersAreExactOrNull) {
  JsonWriter json;
  json.BeginArray().Value(0.1).Value(1e300).Value(std::numeric_limits<double>::infinity());
  json.Value(std::uint64_t{18446744073709551615U}).EndArray();
  EXPECT_EQ(json.text(), "[\n  0.1,\n  1e+300,\n  null,\n  18446744073709551615\n]\n");
}

}  // namespace
}  // namespace gestus::cli
