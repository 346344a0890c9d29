// Windows over streams: everything is covered once, nothing is read past an end.
#include "models/segments.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gestus::models {
namespace {

TEST(WindowsTest, CoverEveryFrameOnce) {
  for (std::int64_t total = 0; total <= 50; ++total) {
    for (std::int64_t length = 1; length <= 20; ++length) {
      std::int64_t covered = 0;
      for (const Window& w : Windows(total, length)) {
        ASSERT_GE(w.begin, 0);
        ASSERT_GE(w.keep, 0);
        ASSERT_LT(w.keep, length);
        ASSERT_EQ(w.begin + w.keep, covered) << total << " frames by " << length;
        // A window stays inside the stream when the stream is long enough.
        if (total >= length) {
          ASSERT_LE(w.begin + length, total);
        }
        covered = std::min(w.begin + length, total);
      }
      ASSERT_EQ(covered, total);
    }
  }
}

TEST(WindowsTest, TheLastOneMovesBack) {
  const std::vector<Window> windows = Windows(20, 8);
  ASSERT_EQ(windows.size(), 3u);
  EXPECT_EQ(windows[1].begin, 8);
  EXPECT_EQ(windows[1].keep, 0);
  EXPECT_EQ(windows[2].begin, 12);
  EXPECT_EQ(windows[2].keep, 4);
}

TEST(CopyWindowTest, RepeatsTheLastRow) {
  const float x[6] = {1, 2, 3, 4, 5, 6};
  float to[10];
  CopyWindow(x, 3, 2, 1, 5, to);
  const float want[10] = {3, 4, 5, 6, 5, 6, 5, 6, 5, 6};
  EXPECT_TRUE(std::equal(to, to + 10, want));
}

TEST(DescribeLastWindowTest, SaysWhatWasDone) {
  EXPECT_EQ(DescribeLastWindow("speech", 16, 8), "");
  EXPECT_EQ(
      DescribeLastWindow("speech", 20, 8),
      "speech: the last 4 frames do not fill a segment; its window was moved back by 4 frames");
  EXPECT_EQ(DescribeLastWindow("clip", 5, 8),
            "clip: 5 frames are fewer than the 8 of a segment; the last one was repeated");
}

}  // namespace
}  // namespace gestus::models
