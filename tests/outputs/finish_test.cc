#include "models/outputs/finish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace gestus::outputs {
namespace {

using Signal = std::function<double(double frame)>;

/// A neck, a joint and one action unit; the joint's x and the unit follow `signal`.
Motion Make(std::int64_t frames, double rate, const Signal& signal,
            std::vector<std::int64_t> seams = {}) {
  Motion motion;
  motion.frame_rate = rate;
  motion.frames = frames;
  motion.seams = std::move(seams);
  Figure body;
  body.points = {{"Neck", -1, 0}, {"RWrist", 0, 3}};
  Curves curves;
  curves.curves = {{"AU01", "intensity", 0, 5}, {"Rx", "rad", -1, 1}};
  for (std::int64_t f = 0; f < frames; ++f) {
    const auto t = static_cast<double>(f);
    const auto x = static_cast<float>(signal(t));
    body.values.insert(body.values.end(), {100 + x, x, 50, static_cast<float>(-2 * signal(t))});
    curves.values.insert(curves.values.end(), {x, x});
  }
  motion.body = std::move(body);
  motion.curves = std::move(curves);
  return motion;
}

std::vector<float> Wrist(const Motion& motion) {
  std::vector<float> x;
  for (std::int64_t f = 0; f < motion.frames; ++f) x.push_back(motion.body->x(f, 1));
  return x;
}

double Wave(double t) { return 3 * std::sin(t / 3) + std::cos(t * 1.7); }

bool Same(const Motion& a, const Motion& b) {
  return a.frames == b.frames && a.body->values == b.body->values &&
         a.curves->values == b.curves->values;
}

TEST(FinishTest, FramesThatFallTogetherKeepEveryBit) {
  const Motion motion = Make(17, 24, Wave);
  for (const Interpolation how : {Interpolation::kMonotone, Interpolation::kLinear}) {
    const Motion fast = Resample(motion, 60, how);  // every fifth frame is every second
    EXPECT_EQ(fast.frames, 42);
    EXPECT_EQ(fast.frame_rate, 60);
    for (std::int64_t f = 0; 2 * f < motion.frames; ++f) {
      if (5 * f < fast.frames) {
        EXPECT_EQ(fast.body->x(5 * f, 1), motion.body->x(2 * f, 1)) << f;
      }
    }
    EXPECT_TRUE(Same(Resample(motion, 24, how), motion));
  }
}

TEST(FinishTest, LinesStayLinesAndTheLastFrameIsHeld) {
  const Motion motion = Make(6, 15, [](double t) { return 2 * t - 3; });
  for (const Interpolation how : {Interpolation::kMonotone, Interpolation::kLinear}) {
    const std::vector<float> x = Wrist(Resample(motion, 50, how));
    ASSERT_EQ(x.size(), 20u);
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_NEAR(x[i], 2 * std::min(static_cast<double>(i) * 15 / 50, 5.0) - 3, 1e-6) << i;
  }
}

TEST(FinishTest, CubicsDoNotOvershoot) {
  const Motion motion = Make(40, 15, [](double t) { return std::fmod(t * t, 7) < 3 ? 0.0 : 4.0; });
  const std::vector<float> before = Wrist(motion), after = Wrist(Resample(motion, 120));
  for (std::size_t i = 0; i < after.size(); ++i) {
    const std::size_t left = i / 8, right = std::min(left + 1, before.size() - 1);
    EXPECT_GE(after[i], std::min(before[left], before[right]));
    EXPECT_LE(after[i], std::max(before[left], before[right]));
  }
}

TEST(FinishTest, SeamsMoveWithTheRate) {
  const Motion motion = Make(20, 15, Wave, {4, 8, 9, 19});
  EXPECT_EQ(Resample(motion, 20).seams, (std::vector<std::int64_t>{6, 11, 12}));
  EXPECT_EQ(Resample(motion, 60).seams, (std::vector<std::int64_t>{16, 32, 36, 76}));
  EXPECT_EQ(Resample(motion, 1).seams, std::vector<std::int64_t>{});
}

// Two lines that meet nowhere: after the cross-fade a third and a second difference as those of the
// cubics that join them, nowhere near the jump; and the same bits everywhere else.
TEST(FinishTest, CrossFadeMakesValueAndVelocityContinuous) {
  const auto lines = [](double t) { return t < 20 ? 0.5 * t : 40 - 1.5 * t; };
  const Motion motion = Make(40, 15, lines, {20});
  const double width = 8;  // frames: 8 / 15 s
  const Motion faded = CrossFade(motion, width / 15);
  const std::vector<float> x = Wrist(faded), old = Wrist(motion);
  for (std::size_t f = 0; f < x.size(); ++f)
    if (f < 12 || f >= 28) {
      EXPECT_EQ(x[f], old[f]) << f;
    }
  // The lines at 19.5: 9.75 and 10.75; slopes 0.5 and -1.5.
  EXPECT_NEAR((x[19] + x[20]) / 2, 10.25, 0.1);
  EXPECT_NEAR(x[20] - x[19], -0.5, 0.05);
  // The second derivative of the fading cubics: at most 6 / width^2 of half the jump and 4 / width
  // of half the turn, on each side.
  const double most = 6 / (width * width) * 0.5 + 4 / width * 1;
  for (std::size_t f = 2; f < x.size(); ++f)
    EXPECT_LE(std::fabs(x[f] - 2 * x[f - 1] + x[f - 2]), most + 1e-5) << f;
  EXPECT_LT(MeanJerk(faded)[0].value, MeanJerk(motion)[0].value);
}

TEST(FinishTest, CrossFadeOfContinuousMotionIsNothing) {
  const Motion motion = Make(30, 15, [](double t) { return 3 * t + 1; }, {7, 16, 29});
  const std::vector<float> x = Wrist(CrossFade(motion, 0.5)), old = Wrist(motion);
  for (std::size_t f = 0; f < x.size(); ++f) EXPECT_NEAR(x[f], old[f], 1e-5) << f;
}

TEST(FinishTest, SeamsOfAnyKind) {
  const auto steps = [](double t) { return std::floor(t / 2) * 10; };
  for (const auto& seams :
       {std::vector<std::int64_t>{}, {1}, {0, -4, 99, 5}, {5, 5, 2, 3, 4}, {1, 2, 3, 4, 5, 6, 7}}) {
    for (const std::int64_t frames : {1, 2, 8}) {
      const Motion motion = Make(frames, 15, steps, seams);
      for (const double seconds : {0.0, 0.01, 0.3, 10.0}) {
        const Motion faded = CrossFade(motion, seconds);
        for (const float x : Wrist(faded)) {
          EXPECT_TRUE(std::isfinite(x));
          EXPECT_GE(x, -6);
          EXPECT_LE(x, 10.0f * static_cast<float>(frames) / 2 + 6);
        }
        if (seconds == 0 || seams.empty()) {
          EXPECT_TRUE(Same(faded, motion));
        }
      }
    }
  }
}

TEST(FinishTest, SmoothingKeepsParabolasAndShortMotion) {
  const Motion motion = Make(30, 15, [](double t) { return 0.1 * t * t - 2 * t + 1; });
  const std::vector<float> x = Wrist(Smooth(motion, 0.6)), old = Wrist(motion);
  for (std::size_t f = 0; f < x.size(); ++f) EXPECT_NEAR(x[f], old[f], 1e-5) << f;
  const Motion noise = Make(30, 15, [](double t) { return std::fmod(t, 2); });
  EXPECT_LT(MeanJerk(Smooth(noise, 0.6))[0].value, MeanJerk(noise)[0].value / 4);
  EXPECT_TRUE(Same(Smooth(noise, 0.2), noise));  // three frames
  const Motion few = Make(4, 15, Wave);
  EXPECT_TRUE(Same(Smooth(few, 1), few));
}

TEST(FinishTest, AmplitudeIsAroundTheMedianAndLeavesTheNeck) {
  const Motion motion = Make(7, 15, Wave);
  EXPECT_TRUE(Same(Amplify(motion, 1), motion));
  const Motion still = Amplify(motion, 0), half = Amplify(motion, 0.5);
  std::vector<float> sorted = Wrist(motion);
  std::sort(sorted.begin(), sorted.end());
  for (std::int64_t f = 0; f < 7; ++f) {
    EXPECT_EQ(still.body->x(f, 1), sorted[3]);
    EXPECT_EQ(still.body->x(f, 0), motion.body->x(f, 0));
    EXPECT_EQ(still.curves->at(f, 1), sorted[3]);
    EXPECT_NEAR(half.body->x(f, 1), (sorted[3] + motion.body->x(f, 1)) / 2, 1e-6);
  }
  EXPECT_EQ(MeanJerk(still)[0].value, 0);
  Motion origin = motion;
  origin.body->neck_is_position = false;
  EXPECT_NE(Amplify(origin, 0).body->x(0, 0), motion.body->x(0, 0));
}

TEST(FinishTest, OnlyActionUnitsAreClamped) {
  const Motion motion = Make(9, 15, [](double t) { return 2 * t - 4; });
  const Motion clamped = Clamp(motion);
  EXPECT_EQ(clamped.body->values, motion.body->values);
  for (std::int64_t f = 0; f < 9; ++f) {
    EXPECT_EQ(clamped.curves->at(f, 0), std::clamp(static_cast<float>(2 * f - 4), 0.0f, 5.0f));
    EXPECT_EQ(clamped.curves->at(f, 1), motion.curves->at(f, 1));
  }
}

// x = t^3 has third differences of 6, y = -2 x; at 10 frames a second.
TEST(FinishTest, JerkHasItsUnit) {
  const Motion motion = Make(12, 10, [](double t) { return t * t * t / 64; });
  const std::vector<Jerk> jerk = MeanJerk(motion);
  ASSERT_EQ(jerk.size(), 3u);
  EXPECT_EQ(jerk[0].part, "body");
  EXPECT_NEAR(jerk[0].value, 6.0 / 64 * std::sqrt(5.0) * 1000 / 167, 1e-4);
  EXPECT_EQ(jerk[0].unit, "shoulder lengths/s^3");
  EXPECT_EQ(jerk[1].part, "action units");
  EXPECT_NEAR(jerk[1].value, 6.0 / 64 * 1000, 1e-2);
  EXPECT_EQ(jerk[2].unit, "rad/s^3");
  EXPECT_TRUE(MeanJerk(Make(3, 10, Wave)).empty());
}

TEST(FinishTest, AllTogether) {
  const Motion motion = Make(64, 15, Wave, {16, 32, 48});
  const auto done = Finish(motion, {.frame_rate = 60, .smooth = 0.2, .amplitude = 0.5});
  ASSERT_TRUE(done.ok());
  const Motion want = Clamp(Smooth(Resample(Amplify(CrossFade(motion, 0.3), 0.5), 60), 0.2));
  EXPECT_TRUE(Same(done->motion, want));
  EXPECT_LT(done->after[0].value, done->before[0].value);
  const auto fewer = Finish(motion, {.frame_rate = 5, .crossfade = 0, .smooth = 0.5});
  ASSERT_TRUE(fewer.ok());
  EXPECT_TRUE(Same(fewer->motion, Clamp(Resample(Smooth(motion, 0.5), 5))));
  const auto plain = Finish(Clamp(motion), {.crossfade = 0});
  ASSERT_TRUE(plain.ok());
  EXPECT_TRUE(Same(plain->motion, Clamp(motion)));
  const auto short_window = Finish(motion, {.smooth = 0.1});
  ASSERT_TRUE(short_window.ok());
  EXPECT_EQ(short_window->notes.size(), 1u);
}

TEST(FinishTest, OneFrameAndLargestNumbers) {
  const Motion one = Make(1, 15, Wave, {1});
  const auto done = Finish(one, {.frame_rate = 100, .smooth = 1, .amplitude = 2});
  ASSERT_TRUE(done.ok());
  EXPECT_EQ(done->motion.frames, 6);
  for (const float x : Wrist(done->motion)) EXPECT_EQ(x, one.body->x(0, 1));
  EXPECT_TRUE(done->after.empty() || done->after[0].value == 0);
  const Motion huge = Make(20, 15, [](double t) { return std::fmod(t, 2) * 3e38 - 1.5e38; }, {10});
  const auto finished = Finish(huge, {.frame_rate = 60, .smooth = 0.5, .amplitude = 10});
  ASSERT_TRUE(finished.ok());
  for (const float x : finished->motion.body->values) EXPECT_TRUE(std::isfinite(x));
}

TEST(FinishTest, OptionsHaveBounds) {
  const Motion motion = Make(10, 15, Wave);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -1.0, 1e9}) {
    for (const FinishOptions& options :
         {FinishOptions{.frame_rate = bad}, FinishOptions{.crossfade = bad},
          FinishOptions{.smooth = bad}, FinishOptions{.amplitude = bad}}) {
      const auto done = Finish(motion, options);
      ASSERT_FALSE(done.ok());
      EXPECT_NE(done.status().message().find("expected"), std::string::npos);
    }
  }
  Motion long_motion;
  long_motion.frames = std::int64_t{1} << 40;  // refused before anything is touched
  EXPECT_EQ(Finish(long_motion, {.frame_rate = 1000}).status().code(), Code::kResourceExhausted);
}

}  // namespace
}  // namespace gestus::outputs
