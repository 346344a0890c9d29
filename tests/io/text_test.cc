// Messages that stay on one line, and numbers that do not depend on the locale.
#include "models/io/text.h"

#include <gtest/gtest.h>

namespace gestus {
namespace {

TEST(OneLine, ControlsAndBrokenUtf8AreEscaped) {
  EXPECT_EQ(OneLine("a\nb\x1b[2J\x7f"), "a\\x0ab\\x1b[2J\\x7f");
  EXPECT_EQ(OneLine("Bew\xc3\xa4gung \xe2\x9c\x93 \xf0\x9f\x99\x82"),
            "Bew\xc3\xa4gung \xe2\x9c\x93 \xf0\x9f\x99\x82");
  EXPECT_EQ(OneLine("\xff \xc3"), "\\xff \\xc3");
  EXPECT_EQ(OneLine("\xc2\x85"), "\\xc2\\x85");           // C1 control
  EXPECT_EQ(OneLine("\xe2\x80\xae"), "\\xe2\\x80\\xae");  // right-to-left override
  EXPECT_EQ(OneLine("\xc0\xaf"), "\\xc0\\xaf");           // overlong
  EXPECT_EQ(OneLine("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // surrogate
}

TEST(OneLine, IsShortenedInTheMiddle) {
  const std::string line = OneLine(std::string(5000, 'p') + ": found, expected rule", 300);
  EXPECT_EQ(line.size(), 300U);
  EXPECT_TRUE(line.ends_with("pp: found, expected rule"));
  std::string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "\xc3\xa4";
  for (std::size_t size = 90; size < 100; ++size) {
    const std::string cut = OneLine(umlauts, size);
    EXPECT_LE(cut.size(), size);
    EXPECT_EQ(OneLine(cut, 300), cut) << "cut inside a character";
  }
}

TEST(Numbers, AreReadable) {
  EXPECT_EQ(Significant(1234.5, 3), "1234");
  EXPECT_EQ(Significant(0.012345, 3), "0.0123");
  EXPECT_EQ(Fixed(2.0 / 3, 2), "0.67");
  EXPECT_EQ(Bytes(999), "999 B");
  EXPECT_EQ(Bytes(87303168), "87.3 MB");
  EXPECT_EQ(Grouped(87303168), "87,303,168");
  EXPECT_EQ(Grouped(100), "100");
  EXPECT_EQ(Seconds(0.00125), "1.25 ms");
  EXPECT_EQ(Count(1, "frame"), "1 frame");
}

TEST(Table, AlignsColumns) {
  EXPECT_EQ(Table({{"a", "1"}, {"bcd", "22"}}, {1}), "  a     1\n  bcd  22\n");
  EXPECT_EQ(Table({{"\xc3\xa4", "x"}, {"bb", ""}}), "  \xc3\xa4   x\n  bb\n");
}

}  // namespace
}  // namespace gestus
