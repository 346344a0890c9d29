// Median, gaps and resampling on small cases with known answers; clean_test.py compares with SciPy.
#include "models/motion/clean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "models/motion/resample.h"

namespace gestus::motion {
namespace {

Track Column(const std::vector<float>& values, const std::vector<float>& confidence,
             double rate = 15) {
  Track track({"a"}, 1, std::ssize(values), rate);
  track.values = values;
  track.confidence = confidence;
  return track;
}

TEST(MedianFilterTest, PutsZerosOrTheEndsBeyondTheEnds) {
  const std::vector<float> x = {5, -7, 6, 9, 1};
  std::vector<float> y(5);
  MedianFilter(x.data(), 5, 3, false, y.data());
  EXPECT_EQ(y, (std::vector<float>{0, 5, 6, 6, 1}));
  MedianFilter(x.data(), 5, 3, true, y.data());
  EXPECT_EQ(y, (std::vector<float>{5, 5, 6, 6, 1}));
  MedianFilter(x.data(), 5, 1, false, y.data());
  EXPECT_EQ(y, x);
  MedianFilter(x.data(), 1, 99, false, y.data());
  EXPECT_EQ(y[0], 0);
  MedianFilter(x.data(), 1, 99, true, y.data());
  EXPECT_EQ(y[0], 5);
}

TEST(FillGapsTest, DrawsLinesAndHoldsTheEnds) {
  std::vector<float> x = {9, 9, 2, 9, 9, 8, 9};
  FillGaps({0, 0, 1, 0, 0, 1, 0}, &x);
  EXPECT_EQ(x, (std::vector<float>{2, 2, 2, 4, 6, 8, 8}));
  FillGaps({0, 0, 0, 0, 0, 0, 0}, &x);
  EXPECT_EQ(x, (std::vector<float>{2, 2, 2, 4, 6, 8, 8}));
  std::vector<float> none;
  FillGaps({}, &none);
}

TEST(CleanTest, OrderMatters) {
  // A lost frame that stands as 0 in the file.
  const std::vector<float> values = {4, 5, 0, 7, 8, 9, 8}, seen = {1, 1, 0, 1, 1, 1, 1};
  Track thesis = Column(values, seen), points = Column(values, seen);
  ASSERT_TRUE(Clean(&thesis, {.median = 3}).ok());
  EXPECT_EQ(thesis.values, (std::vector<float>{4, 4, 5.5f, 7, 8, 8, 8}));
  ASSERT_TRUE(Clean(&points, {.median = 3, .order = CleanOrder::kFillFirst}).ok());
  EXPECT_EQ(points.values, (std::vector<float>{4, 5, 6, 7, 8, 8, 8}));
}

TEST(CleanTest, CountsWhatItFilled) {
  Track track({"a", "b", "c"}, 2, 6, 15);
  for (std::int64_t t = 0; t < 6; ++t) {
    for (std::int64_t p = 0; p < 3; ++p) track.value(t, 1, p) = static_cast<float>(10 * p + t);
    track.seen(t, 0) = t == 0 || t == 5 ? 0.9f : 0.05f;
    track.seen(t, 1) = t == 3 ? 0.0f : 0.5f;
    track.seen(t, 2) = 0.1f;
  }
  const auto report = Clean(&track, {.median = 1, .min_confidence = 0.1f});
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->lost_frames, 1);
  EXPECT_EQ(report->filled_points, 5);
  EXPECT_EQ(report->longest_gap, 4);
  EXPECT_EQ(report->never_seen, std::vector<std::string>{"c"});
  EXPECT_EQ(report->notes,
            (std::vector<std::string>{"1 frame of 6 lost, 5 points filled in, 4 in a row at most",
                                      "1 point never seen: c"}));
  EXPECT_EQ(track.value(2, 1, 0), 2);
  EXPECT_EQ(track.value(3, 1, 1), 13);
  EXPECT_EQ(track.seen(3, 1), 0);
  EXPECT_TRUE(track.Has(0));
  EXPECT_FALSE(track.Has(2));
}

TEST(CleanTest, LeavesACleanTrackWithoutNotes) {
  Track track = Column({1, 2, 3}, {1, 1, 1});
  const auto report = Clean(&track, {.median = 1});
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->notes.empty());
  EXPECT_EQ(track.values, (std::vector<float>{1, 2, 3}));
}

TEST(CleanTest, SaysWhatIsWrong) {
  Track track = Column({1, 2}, {0.5f, 0});
  const auto error = [&](const CleanOptions& options) {
    return Clean(&track, options).status().message();
  };
  for (const int median : {0, 2, -7, 101}) {
    EXPECT_EQ(error({.median = median}), "a median of " + std::to_string(median) +
                                             " frames, expected an odd number from 1 to 99");
  }
  for (const float least : {-0.1f, 1.0f, std::nanf("")}) {
    EXPECT_NE(error({.min_confidence = least}).find("expected 0 or more and less than 1"),
              std::string::npos);
  }
  EXPECT_EQ(error({.min_confidence = 0.5f}),
            "nothing was seen in 2 frames with a confidence above 0.500, expected one frame at "
            "least");
  Track none;
  EXPECT_FALSE(Clean(&none).ok());
}

TEST(ResampleTest, DrawsLinesAtExactTimes) {
  // 10 to 15 frames a second: frame i stands at 2 i / 3.
  const auto up = Resample(Column({0, 3, 6, 0}, {1, 0.5f, 1, 1}, 10), 15);
  ASSERT_TRUE(up.ok());
  ASSERT_EQ(up->frames, 6);
  EXPECT_EQ(up->frame_rate, 15);
  const float want[] = {0, 2, 4, 6, 2, 0};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(up->values[i], want[i], 1e-6) << i;
  EXPECT_EQ(up->confidence, (std::vector<float>{1, 0.5f, 0.5f, 1, 1, 1}));
}

TEST(ResampleTest, CountsFramesByTime) {
  const auto frames = [](std::int64_t n, double from, double to) {
    const auto made = Resample(Track({"a"}, 2, n, from), to);
    return made.ok() ? made->frames : -1;
  };
  EXPECT_EQ(frames(25, 25, 15), 15);
  EXPECT_EQ(frames(24, 24, 15), 15);
  EXPECT_EQ(frames(60, 60, 15), 15);
  EXPECT_EQ(frames(30000, 30e3 / 1001, 15), 15015);
  EXPECT_EQ(frames(29999, 30e3 / 1001, 15), 15014);
  EXPECT_EQ(frames(490, 25, 15), 294);
  EXPECT_EQ(frames(1, 60, 15), 1);
  EXPECT_EQ(frames(7, 15, 15), 7);
}

TEST(ResampleTest, SaysWhatIsWrong) {
  const auto error = [](const Track& track, double rate) {
    return Resample(track, rate).status().message();
  };
  EXPECT_EQ(error(Column({1}, {1}), 0),
            "the frame rate to resample to is 0, expected 1 to 1000 frames per second");
  EXPECT_NE(error(Column({1}, {1}, std::numeric_limits<double>::quiet_NaN()), 15)
                .find("the frame rate of the clip is nan"),
            std::string::npos);
  EXPECT_EQ(error(Column({}, {}), 15), "a clip without frames, expected one at least");
}

}  // namespace
}  // namespace gestus::motion
