// SWIPE' on sounds whose pitch is known, in pieces, and on what is no voice.  Its digits are
// compared with a transcription of the definition in swipe_test.py.
#include "models/prosody/swipe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "tests/prosody/signals.h"

namespace gestus::prosody {
namespace {

using test::Samples;

Swipe Make(const SwipeOptions& options) {
  auto made = Swipe::Make(options);
  EXPECT_TRUE(made.ok()) << made.status().message();
  return *std::move(made);
}

Samples RowsOf(const SwipeOptions& options, const Samples& x, std::size_t piece = 1 << 20) {
  Swipe swipe = Make(options);
  return test::Rows(swipe, x, piece);
}

class KnownPitch : public testing::TestWithParam<std::tuple<double, SwipeMode>> {
 protected:
  SwipeOptions options() const {
    return {.sample_rate = std::get<0>(GetParam()), .mode = std::get<1>(GetParam())};
  }
};

// The windows are as wide as 8 periods of 70 to 100 Hz, so the first and last rows hear half a
// sound.
constexpr std::size_t kEdge = 15;

// Candidates are 0.7 % apart; SPTK's spline bends the spectrum further.
TEST_P(KnownPitch, OfHarmonics) {
  const double bound = options().mode == SwipeMode::kSptk ? 0.015 : 0.003;
  for (const double hz : {60.0, 83.3, 121.0, 199.0, 287.5, 401.0, 500.0}) {
    const Samples rows = RowsOf(options(), test::Tone(options().sample_rate, 0.6, hz));
    ASSERT_EQ(rows.size(), 60 * Swipe::kColumns);
    for (std::size_t j = kEdge; j < 60 - kEdge; ++j) {
      EXPECT_NEAR(rows[2 * j], hz, bound * hz) << hz << " row " << j;
      EXPECT_GT(rows[2 * j + 1], options().threshold);
      EXPECT_LE(rows[2 * j + 1], 1.0f);
    }
  }
}

TEST_P(KnownPitch, OfAMissingFundamental) {
  // Equal harmonics 2 to 9: nothing sounds at 150 Hz.
  const Samples x = test::Harmonics(
      options().sample_rate, 0.6, [](double) { return 150.0; }, 2, 9, 0);
  const Samples rows = RowsOf(options(), x);
  for (std::size_t j = kEdge; j < 60 - kEdge; ++j)
    EXPECT_NEAR(rows[2 * j], 150, 1.5) << "row " << j;
}

// A pure tone leaves more candidates in the run: all harmonics but the first are silent.
TEST_P(KnownPitch, OfASine) {
  const Samples x = test::Harmonics(
      options().sample_rate, 0.6, [](double) { return 220.0; }, 1, 1);
  const Samples rows = RowsOf(options(), x);
  for (std::size_t j = kEdge; j < 60 - kEdge; ++j) EXPECT_NEAR(rows[2 * j], 220, 15) << "row " << j;
}

TEST_P(KnownPitch, OfAGlide) {
  const auto hz = [](double t) { return 100 * std::exp2(t); };  // an octave a second
  const Samples rows = RowsOf(options(), test::Harmonics(options().sample_rate, 2, hz));
  ASSERT_EQ(rows.size(), 200 * Swipe::kColumns);
  for (std::size_t j = kEdge; j < 200 - kEdge; ++j)
    EXPECT_NEAR(rows[2 * j] / hz(0.01 * static_cast<double>(j)), 1, 0.01) << "row " << j;
}

TEST_P(KnownPitch, NoiseAndSilenceHaveNone) {
  const auto second = static_cast<std::size_t>(options().sample_rate);
  for (const Samples& x :
       {test::Noise(3 * second, 0.1), Samples(second, 0.0f), Samples(second, 0.5f)}) {
    const Samples rows = RowsOf(options(), x);
    for (std::size_t j = kEdge; j < rows.size() / 2 - kEdge; ++j)
      ASSERT_EQ(rows[2 * j], 0.0f) << "row " << j << " strength " << rows[2 * j + 1];
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, KnownPitch,
                         testing::Combine(testing::Values(8000.0, 16000.0, 22050.0, 44100.0,
                                                          48000.0, 96000.0),
                                          testing::Values(SwipeMode::kTextbook, SwipeMode::kSptk)));

TEST(SwipeTest, SilenceIsZeroInEveryDigit) {
  for (const SwipeMode mode : {SwipeMode::kTextbook, SwipeMode::kSptk})
    for (const float v : RowsOf({.mode = mode}, Samples(16000, 0.0f))) ASSERT_EQ(v, 0.0f);
}

TEST(SwipeTest, ClippedVoicesKeepTheirPitch) {
  Samples x = test::Tone(16000, 0.6, 150);
  for (float& v : x) v = v > 0 ? 1.0f : -1.0f;
  const Samples rows = RowsOf({}, x);
  for (std::size_t j = kEdge; j < 60 - kEdge; ++j) EXPECT_NEAR(rows[2 * j], 150, 1.5);
}

TEST(SwipeTest, LoudnessDoesNotMatter) {
  const Samples x = test::Tone(16000, 0.6, 150);
  const Samples want = RowsOf({}, x);
  for (const float gain : {1e-6f, 1e3f, 1e30f}) {
    Samples louder = x;
    for (float& v : louder) v *= gain;
    const Samples rows = RowsOf({}, louder);
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i], want[i], 1e-5 * want[i]);
  }
}

TEST(SwipeTest, PiecesGiveTheSameBytes) {
  Samples x = test::Harmonics(22050, 1.3, [](double t) { return 90 + 200 * t; });
  const Samples noise = test::Noise(x.size(), 0.02);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += noise[i];
  for (const SwipeMode mode : {SwipeMode::kTextbook, SwipeMode::kSptk}) {
    const SwipeOptions options{.sample_rate = 22050, .hop_seconds = 0.0073, .mode = mode};
    const Samples want = RowsOf(options, x);
    EXPECT_EQ(want.size() / 2, std::ceil(static_cast<double>(x.size()) / (22050 * 0.0073)));
    for (const std::size_t piece : {1, 7, 160, 1023, 2048, 5000, 12289})
      EXPECT_EQ(RowsOf(options, x, piece), want) << piece;
  }
}

TEST(SwipeTest, StartsAnewAfterFinish) {
  Swipe swipe = Make({});
  const Samples a = test::Tone(16000, 0.5, 130), b = test::Noise(3000, 0.2);
  const Samples first = test::Rows(swipe, a, 999);
  (void)test::Rows(swipe, b, 100);
  EXPECT_EQ(test::Rows(swipe, a), first);
}

TEST(SwipeTest, RowsComeWithinTheLatency) {
  Swipe swipe = Make({});
  EXPECT_EQ(swipe.Latency(), 2048u);
  const Samples x = test::Tone(16000, 1, 130);
  Samples rows(swipe.MaxRows(x.size()) * Swipe::kColumns);
  std::size_t given = 0;
  for (std::size_t at = 0; at < x.size(); ++at) {
    given += swipe.Push(&x[at], 1, rows.data());
    if (at >= swipe.Latency()) {
      ASSERT_GT(160 * given, at - swipe.Latency()) << "after sample " << at;
    }
  }
}

TEST(SwipeTest, RoomIsEnoughForAnyPiece) {
  std::mt19937 random(5);
  const SwipeOptions options{.sample_rate = 8000, .hop_seconds = 0.0009};
  Swipe swipe = Make(options);
  const Samples x = test::Noise(4000, 0.1);
  for (int round = 0; round < 20; ++round) {
    std::size_t total = 0;
    for (std::size_t at = 0; at < x.size();) {
      const std::size_t n = std::min<std::size_t>(random() % 1500, x.size() - at);
      Samples rows(swipe.MaxRows(n) * Swipe::kColumns);  // a sanitizer watches its end
      total += swipe.Push(x.data() + at, n, rows.data());
      at += n;
    }
    Samples rows(swipe.MaxRowsAtFinish() * Swipe::kColumns);
    total += swipe.Finish(rows.data());
    ASSERT_EQ(total, 556u);  // ceil(4000 / 7.2)
  }
}

TEST(SwipeTest, ShortRecordings) {
  for (const std::size_t n : {0, 1, 100, 159, 160, 161, 2047, 2048, 2049}) {
    const Samples x(n, 0.1f);
    EXPECT_EQ(RowsOf({}, x).size() / 2, (n + 159) / 160) << n;
    EXPECT_EQ(RowsOf({.hop_seconds = 10}, x).size() / 2, n > 0 ? 1u : 0u) << n;
  }
}

// A frame that holds such a sample is silent; what lies a window away is as if it were not there.
TEST(SwipeTest, NotANumberPasses) {
  for (const SwipeMode mode : {SwipeMode::kTextbook, SwipeMode::kSptk}) {
    const Samples x = test::Tone(16000, 1, 150);
    const Samples want = RowsOf({.mode = mode}, x);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), -3e38f}) {
      Samples broken = x;
      broken[8000] = bad;
      const Samples rows = RowsOf({.mode = mode}, broken);
      ASSERT_EQ(rows.size(), want.size());
      for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_TRUE(std::isfinite(rows[i]));
      for (std::size_t j = 0; j < 100; ++j) {
        if (j + 20 < 50 || j > 50 + 20) {
          ASSERT_EQ(rows[2 * j], want[2 * j]) << j;
          ASSERT_EQ(rows[2 * j + 1], want[2 * j + 1]) << j;
        }
      }
      EXPECT_EQ(rows[2 * 50], 0.0f);
    }
    for (const float v : RowsOf({.mode = mode}, Samples(9000, NAN))) ASSERT_EQ(v, 0.0f);
  }
}

TEST(SwipeTest, OddRangesWork) {
  const Samples x = test::Tone(16000, 0.6, 103);
  for (const SwipeMode mode : {SwipeMode::kTextbook, SwipeMode::kSptk}) {
    // One window, two windows, nine of them.
    for (const auto& [low, high] : {std::pair(100.0, 106.0), {90.0, 130.0}, {10.0, 4000.0}}) {
      const Samples rows = RowsOf({.min_hz = low, .max_hz = high, .mode = mode}, x);
      EXPECT_NEAR(rows[2 * 30], 103, 2) << low << " to " << high;
    }
  }
}

TEST(SwipeTest, SaysWhatIsWrong) {
  const auto error = [](const SwipeOptions& o) { return Swipe::Make(o).status().message(); };
  EXPECT_EQ(error({.sample_rate = 0}), "sample_rate is 0, expected 4,000 to 384,000 Hz");
  EXPECT_EQ(error({.sample_rate = NAN}), "sample_rate is nan, expected 4,000 to 384,000 Hz");
  EXPECT_EQ(error({.hop_seconds = 0}), "hop_seconds is 0, expected one sample to 60 s");
  EXPECT_EQ(error({.hop_seconds = -0.01}), "hop_seconds is -0.01, expected one sample to 60 s");
  EXPECT_EQ(error({.hop_seconds = 61}), "hop_seconds is 61, expected one sample to 60 s");
  EXPECT_EQ(error({.min_hz = 5}), "min_hz is 5, expected at least 10 Hz");
  EXPECT_EQ(error({.min_hz = 550, .max_hz = 50}),
            "max_hz is 50, expected at least 5 % above min_hz, 550");
  EXPECT_EQ(error({.min_hz = 100, .max_hz = 100}),
            "max_hz is 100, expected at least 5 % above min_hz, 100");
  EXPECT_EQ(error({.sample_rate = 8000, .max_hz = 2500}),
            "max_hz is 2500, expected at most 2000 Hz, the lesser of 5,000 and a quarter of the "
            "sample rate");
  EXPECT_EQ(error({.threshold = 2}), "threshold is 2, expected 0 to 1");
  EXPECT_EQ(error({.threshold = NAN}), "threshold is nan, expected 0 to 1");
}

}  // namespace
}  // namespace gestus::prosody
