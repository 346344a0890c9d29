#include "models/audio/frames.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gestus::audio {
namespace {

// PATS' loader, spelled out: windows of int(time * fs) rows, of each every round(fs / 15)-th.
TEST(FramesTest, PlacesRowsAsPats) {
  const RowPlan plan{.placement = RowPlacement::kPats};
  std::int64_t frame = 0;
  for (std::int64_t start = 0; start < 20 * 382; start += 382) {
    int taken = 0;
    for (std::int64_t row = start; row < start + 382; row += 6, ++taken, ++frame) {
      ASSERT_EQ(RowOfFrame(plan, frame), row) << frame;
    }
    ASSERT_EQ(taken, 64);
  }
}

TEST(FramesTest, PlacesShortSegmentsAsPats) {
  const RowPlan plan{.placement = RowPlacement::kPats, .segments = {.frames = 16, .seconds = 1.07}};
  std::int64_t frame = 0;
  for (std::int64_t start = 0; start < 20 * 95; start += 95) {
    for (std::int64_t row = start; row < start + 95; row += 6, ++frame) {
      ASSERT_EQ(RowOfFrame(plan, frame), row) << frame;
    }
  }
  EXPECT_EQ(frame, 320);
  const RowPlan slow{.segments = {.rows_per_second = 103}};  // log_mel_400: 442 rows, every 7th
  EXPECT_EQ(RowOfFrame(slow, 63), 441);
  EXPECT_EQ(RowOfFrame(slow, 64), 442);
}

TEST(FramesTest, FindsTheNearestRow) {
  struct Case {
    RowTimes times;
    int frames_per_second;
  };
  for (const Case& c :
       {Case{{44100, 512, 0}, 15}, Case{{48000, 512, 0}, 15}, Case{{16000, 160, 200}, 15},
        Case{{16000, 160, 256}, 24}, Case{{8000, 512, 0}, 30}}) {
    const RowPlan plan{.placement = RowPlacement::kExact,
                       .times = c.times,
                       .frames_per_second = c.frames_per_second};
    const auto seconds_of = [&](std::int64_t row) {
      return static_cast<double>(c.times.first_middle + row * c.times.hop) /
             static_cast<double>(c.times.sample_rate);
    };
    for (std::int64_t frame = 0; frame < 2000; ++frame) {
      const std::int64_t row = RowOfFrame(plan, frame);
      const double at = static_cast<double>(frame) / c.frames_per_second;
      ASSERT_GE(row, 0);
      const double away = std::fabs(seconds_of(row) - at);
      ASSERT_LE(away, std::fabs(seconds_of(row + 1) - at) + 1e-9) << frame;
      if (row > 0) {
        ASSERT_LE(away, std::fabs(seconds_of(row - 1) - at) + 1e-9) << frame;
      }
    }
  }
}

TEST(FramesTest, ExactPlacementDoesNotDrift) {
  const RowPlan plan{.placement = RowPlacement::kExact, .times = {44100, 512, 0}};
  const std::int64_t frame = 15 * 36000;  // after ten hours
  EXPECT_EQ(RowOfFrame(plan, frame), std::llround(36000.0 * 44100 / 512));
}

// The drift that docs/features/audio.md tells of.
TEST(FramesTest, PatsPlacementDrifts) {
  const RowPlan plan{.placement = RowPlacement::kPats};
  const auto ahead = [&](double rate, std::int64_t frame) {
    return static_cast<double>(RowOfFrame(plan, frame)) * 512 / rate -
           static_cast<double>(frame) / 15;
  };
  EXPECT_NEAR(ahead(44100, 63), 0.189, 5e-4);
  EXPECT_NEAR(ahead(44100, 64), 0.168, 5e-4);
  EXPECT_NEAR(ahead(48000, 63), -0.168, 5e-4);
  EXPECT_NEAR(ahead(48000, 64), -0.192, 5e-4);
  EXPECT_NEAR(ahead(44100, 64 * 14), 14 * 0.1683, 5e-3);  // a minute
  EXPECT_NEAR(ahead(48000, 64 * 14), -14 * 0.1920, 5e-3);
}

TEST(FramesTest, CountsFramesWithinRows) {
  const RowPlan plans[] = {{.placement = RowPlacement::kPats},
                           {.placement = RowPlacement::kExact, .times = {44100, 512, 0}},
                           {.placement = RowPlacement::kExact, .times = {16000, 160, 200}}};
  for (const RowPlan& plan : plans) {
    for (std::int64_t rows = 0; rows < 1000; ++rows) {
      std::int64_t frames = 0;
      while (RowOfFrame(plan, frames) < rows) ++frames;
      ASSERT_EQ(FramesWithin(plan, rows), frames) << rows;
    }
  }
}

}  // namespace
}  // namespace gestus::audio
