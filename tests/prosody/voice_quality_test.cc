// Jitter, shimmer, harmonic-to-noise ratio and Hammarberg index of sounds for which they are known.
#include "models/prosody/voice_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/prosody/signals.h"

namespace gestus::prosody {
namespace {

using test::Samples;

constexpr std::size_t kColumns = VoiceQuality::kColumns, kEdge = 15;
enum Column { kF0, kStrength, kJitter, kShimmer, kHarmonics, kHammarberg };

VoiceQuality Make(double rate) {
  auto made = VoiceQuality::Make({.swipe = {.sample_rate = rate}});
  EXPECT_TRUE(made.ok()) << made.status().message();
  return *std::move(made);
}

Samples RowsOf(double rate, const Samples& x, std::size_t piece = 1 << 20) {
  VoiceQuality stage = Make(rate);
  return test::Rows(stage, x, piece);
}

// Mean and largest distance from `want` of a column, away from the ends; all rows are voiced.
struct Errors {
  double mean = 0, largest = 0;
};
Errors ErrorsOf(const Samples& rows, Column column, double want) {
  Errors errors;
  const std::size_t count = rows.size() / kColumns;
  for (std::size_t j = kEdge; j < count - kEdge; ++j) {
    const float* row = rows.data() + j * kColumns;
    EXPECT_GT(row[kF0], 0.0f) << "row " << j;
    errors.mean += (double{row[column]} - want) / static_cast<double>(count - 2 * kEdge);
    errors.largest = std::max(errors.largest, std::fabs(double{row[column]} - want));
  }
  return errors;
}

class KnownQuality : public testing::TestWithParam<double> {};

// Periods alternate between T (1 + d) and T (1 - d): neighbours differ by 2 d.
TEST_P(KnownQuality, Jitter) {
  for (const double hz : {81.0, 120.0, 205.0, 310.0}) {
    for (const double d : {0.0, 0.002, 0.005, 0.01}) {
      const Samples rows = RowsOf(GetParam(), test::Pulses(GetParam(), 1, hz, d, 0));
      EXPECT_LT(ErrorsOf(rows, kJitter, 2 * d).largest, 0.0005) << hz << " Hz, " << d;
    }
  }
}

TEST_P(KnownQuality, Shimmer) {
  for (const double hz : {81.0, 120.0, 205.0, 310.0}) {
    for (const double d : {0.0, 0.01, 0.05, 0.1}) {
      const Samples rows = RowsOf(GetParam(), test::Pulses(GetParam(), 1, hz, 0, d));
      const double want = 20 * std::log10((1 + d) / (1 - d));
      EXPECT_LT(ErrorsOf(rows, kShimmer, want).largest, 0.01) << hz << " Hz, " << d;
    }
  }
}

// White noise does not resemble itself a period later.  A frame of 60 ms estimates the share with a
// spread of a few tenths of a dB.
TEST_P(KnownQuality, HarmonicsToNoise) {
  for (const double hz : {81.0, 205.0}) {
    const Samples clean = test::Tone(GetParam(), 1, hz);
    double power = 0;
    for (const float v : clean) power += double{v} * double{v} / static_cast<double>(clean.size());
    for (const double want : {10.0, 20.0, 30.0}) {
      const Samples noise = test::Noise(clean.size(), std::sqrt(power / std::pow(10, want / 10)));
      Samples x = clean;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += noise[i];
      const Errors errors = ErrorsOf(RowsOf(GetParam(), x), kHarmonics, want);
      EXPECT_LT(std::fabs(errors.mean), 0.6) << hz << " Hz, " << want << " dB";
      EXPECT_LT(errors.largest, 2.0) << hz << " Hz, " << want << " dB";
    }
  }
}

// Harmonics that fall by k^slope: the first against the lowest one above 2 kHz.
TEST_P(KnownQuality, Hammarberg) {
  for (const double hz : {83.0, 121.0, 207.0, 311.0}) {
    for (const double slope : {0.0, 1.0, 2.0}) {
      const Samples x = test::Harmonics(
          GetParam(), 1, [hz](double) { return hz; }, 1, 1000, slope);
      const double want = 20 * slope * std::log10(std::floor(2000 / hz) + 1);
      const Samples rows = RowsOf(GetParam(), x);
      for (std::size_t j = kEdge; j < 100 - kEdge; ++j)
        EXPECT_NEAR(rows[j * kColumns + kHammarberg], want, 0.2) << hz << " Hz, " << slope;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, KnownQuality, testing::Values(8000.0, 16000.0, 22050.0, 48000.0));

TEST(VoiceQualityTest, TimesAndPitchAreThoseOfSwipe) {
  const Samples x = test::Harmonics(16000, 1.17, [](double t) { return 90 + 150 * t; });
  auto swipe = Swipe::Make({});
  ASSERT_TRUE(swipe.ok());
  const Samples pitch = test::Rows(*swipe, x), rows = RowsOf(16000, x);
  ASSERT_EQ(rows.size() / kColumns, pitch.size() / 2);
  for (std::size_t j = 0; j < pitch.size() / 2; ++j) {
    EXPECT_EQ(rows[j * kColumns], pitch[2 * j]);
    EXPECT_EQ(rows[j * kColumns + 1], pitch[2 * j + 1]);
  }
}

// A burst of a tone at 3 kHz lights up the rows whose frames hold it.
TEST(VoiceQualityTest, FramesAreCentredOnTheirTime) {
  Samples x(16000, 0.0f);
  for (std::size_t i = 0; i < 160; ++i)
    x[8000 + i] = static_cast<float>(std::sin(test::kTurn * 3000 * static_cast<double>(i) / 16000));
  const Samples rows = RowsOf(16000, x);
  for (std::size_t j = 0; j < 100; ++j)
    EXPECT_EQ(rows[j * kColumns + kHammarberg]<0, j> 50 - 3 && j < 51 + 3) << j;
}

TEST(VoiceQualityTest, PiecesGiveTheSameBytes) {
  Samples x = test::Pulses(22050, 1.3, 110, 0.004, 0.03);
  const Samples noise = test::Noise(x.size(), 0.01);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += noise[i];
  const Samples want = RowsOf(22050, x);
  for (const std::size_t piece : {1, 7, 1023, 5000}) EXPECT_EQ(RowsOf(22050, x, piece), want);
}

TEST(VoiceQualityTest, StartsAnewAfterFinish) {
  VoiceQuality stage = Make(16000);
  const Samples a = test::Pulses(16000, 0.5, 130, 0, 0), b = test::Noise(30000, 0.2);
  const Samples first = test::Rows(stage, a, 999);
  (void)test::Rows(stage, b, 100);
  EXPECT_EQ(test::Rows(stage, a), first);
}

TEST(VoiceQualityTest, NothingToMeasure) {
  for (const float level : {0.0f, 0.5f, std::numeric_limits<float>::quiet_NaN()}) {
    const Samples rows = RowsOf(16000, Samples(16000, level));
    // Where a constant starts and ends, it is none.
    for (std::size_t i = kEdge * kColumns; i < rows.size() - kEdge * kColumns; ++i)
      ASSERT_EQ(rows[i], 0.0f) << level;
  }
  EXPECT_TRUE(RowsOf(16000, {}).empty());
  EXPECT_EQ(RowsOf(16000, Samples(1, 0.1f)).size(), kColumns);
}

TEST(VoiceQualityTest, AnySoundGivesFiniteNumbers) {
  Samples square = test::Tone(16000, 1, 97);
  for (float& v : square) v = v > 0 ? 1.0f : -1.0f;
  Samples broken = test::Tone(16000, 1, 300);
  broken[7000] = std::numeric_limits<float>::infinity();
  broken[9000] = std::numeric_limits<float>::quiet_NaN();
  Samples loud = test::Tone(16000, 1, 200);
  for (float& v : loud) v *= 1e30f;
  const Samples sine = test::Harmonics(
      16000, 1, [](double) { return 499.0; }, 1, 1);
  for (const double rate : {8000.0, 22050.0, 96000.0})
    for (const Samples& x : {square, broken, loud, sine, test::Noise(16000, 0.3)})
      for (const float v : RowsOf(rate, x)) ASSERT_TRUE(std::isfinite(v));
}

TEST(VoiceQualityTest, SaysWhatIsWrong) {
  const auto error = [](const VoiceQualityOptions& o) {
    return VoiceQuality::Make(o).status().message();
  };
  EXPECT_EQ(error({.swipe = {.threshold = 2}}), "threshold is 2, expected 0 to 1");
  EXPECT_EQ(error({.swipe = {.sample_rate = 4000}}),
            "sample_rate is 4000, expected at least 8,000 Hz for the band from 2 kHz on");
  EXPECT_EQ(error({.frame_seconds = 0.05}),
            "frame_seconds is 0.05, expected 0.06, three periods of min_hz, to 0.09725");
  EXPECT_EQ(error({.frame_seconds = 1}),
            "frame_seconds is 1, expected 0.06, three periods of min_hz, to 0.09725");
  EXPECT_EQ(error({.frame_seconds = NAN}),
            "frame_seconds is nan, expected 0.06, three periods of min_hz, to 0.09725");
  EXPECT_EQ(error({.swipe = {.sample_rate = 8000, .min_hz = 711, .max_hz = 900}}),
            "min_hz is 711, expected less for frames of three periods at this sample rate");
}

}  // namespace
}  // namespace gestus::prosody
