#include "models/io/reading.h"

#include <gtest/gtest.h>

#include <clocale>
#include <string>

namespace gestus {
namespace {

TEST(ParseNumberTest, TakesDecimalNumbersOnly) {
  double value = 0;
  for (const auto& [text, want] : std::initializer_list<std::pair<const char*, double>>{
           {"0", 0}, {" 1.5\r", 1.5}, {"-2e3", -2000}, {"+.25", 0.25}, {"3.", 3}}) {
    EXPECT_TRUE(ParseNumber(text, &value)) << text;
    EXPECT_EQ(value, want) << text;
  }
  for (const char* text :
       {"", " ", "+", "1,5", "nan", "inf", "0x10", "1e999", "1 2", "12s", "--1"}) {
    EXPECT_FALSE(ParseNumber(text, &value)) << text;
  }
}

TEST(ParseNumberTest, KnowsNoLocale) {
  double value = 0;
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, locale) == nullptr) continue;
    EXPECT_TRUE(ParseNumber("1.5", &value));
    EXPECT_EQ(value, 1.5);
    EXPECT_FALSE(ParseNumber("1,5", &value));
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(ReadFileTest, SaysWhatIsWrong) {
  const Result<std::string> missing = ReadFile("no/such/file", 10);
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.status().message().find("no/such/file: cannot be opened"), std::string::npos);
  const Result<std::string> large = ReadFile("/proc/self/exe", 10);
  ASSERT_FALSE(large.ok());
  EXPECT_NE(large.status().message().find("expected at most"), std::string::npos);
}

}  // namespace
}  // namespace gestus
