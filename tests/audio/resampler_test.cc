// The resampler against the sound that its samples stand for: sines, whose value is known at every
// time.
#include "models/audio/resampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "models/audio/rows.h"
#include "tests/audio/sounds.h"

namespace gestus::audio {
namespace {

struct Rates {
  int from, to;
};

std::string Name(const Rates& rates) {
  return std::to_string(rates.from) + "_to_" + std::to_string(rates.to);
}
void PrintTo(const Rates& rates, std::ostream* out) { *out << Name(rates); }

// Ratios with filters for every phase, and such with a line between two.
const Rates kRates[] = {{44100, 16000}, {48000, 16000},  {16000, 44100},  {44100, 48000},
                        {8000, 16000},  {96000, 44100},  {22050, 16000},  {11025, 16000},
                        {44100, 48001}, {48001, 44100},  {383999, 16000}, {192000, 16001},
                        {1000, 16000},  {16000, 383999}, {47999, 48000}};

double Sine(double hz, double seconds) {
  return std::sin(2 * std::numbers::pi * std::fmod(hz * seconds, 1.0) + 0.3);
}

// The largest distance between what comes out for a sine and `want` times the sine itself, away
// from the ends, where the silence outside is heard.
double Error(const Rates& rates, double hz, double want) {
  const double lower = std::min(rates.from, rates.to);
  const double edge = 80 / lower, seconds = 2 * edge + 300 / lower;
  std::vector<float> samples(static_cast<std::size_t>(seconds * rates.from));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = static_cast<float>(Sine(hz, static_cast<double>(i) / rates.from));
  }
  Result<Resampler> resampler = Resampler::Make(rates.from, rates.to);
  EXPECT_TRUE(resampler.ok());
  const std::vector<float> out = AllRows(&*resampler, samples.data(), samples.size());
  double error = 0;
  std::size_t compared = 0;
  for (std::size_t m = 0; m < out.size(); ++m) {
    const double at = static_cast<double>(m) / rates.to;
    if (at < edge || at > seconds - edge) continue;
    ++compared;
    error = std::max(error, std::fabs(out[m] - want * Sine(hz, at)));
  }
  EXPECT_GT(compared, 100u);
  return error;
}

class ResamplerTest : public testing::TestWithParam<Rates> {};

TEST_P(ResamplerTest, KeepsWhatBothRatesHold) {
  const double lower = std::min(GetParam().from, GetParam().to);
  double worst = 0;
  for (const double share : {0.0, 0.01, 0.1, 0.23, 0.5, 0.71, 0.85, 0.9}) {
    worst = std::max(worst, Error(GetParam(), share * lower / 2, 1));
  }
  std::printf("%d to %d: pass-band %.1f dB\n", GetParam().from, GetParam().to,
              20 * std::log10(worst));
  EXPECT_LT(worst, 1e-5);  // -100 dB: flatness, delay, images and rounding in one
}

TEST_P(ResamplerTest, HalvesTheAmplitudeAtItsCorner) {
  const double lower = std::min(GetParam().from, GetParam().to);
  EXPECT_LT(Error(GetParam(), 0.95 * lower / 2, 0.5), 2e-3);
}

TEST_P(ResamplerTest, RemovesWhatTheLowerRateCannotHold) {
  const Rates& rates = GetParam();
  if (rates.to > rates.from) return;  // what comes in has nothing above half its rate
  double worst = 0;
  for (double hz = rates.to / 2.0; hz < rates.from / 2.0; hz += (rates.from - rates.to) / 37.0) {
    worst = std::max(worst, Error(rates, hz, 0));
  }
  std::printf("%d to %d: stop-band %.1f dB\n", rates.from, rates.to, 20 * std::log10(worst));
  EXPECT_LT(worst, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Rates, ResamplerTest, testing::ValuesIn(kRates),
                         [](const auto& test) { return Name(test.param); });

TEST(ResamplerTest, EqualRatesChangeNothing) {
  const std::vector<float> samples = Noise(1000);
  Result<Resampler> resampler = Resampler::Make(44100, 44100);
  ASSERT_TRUE(resampler.ok());
  EXPECT_EQ(AllRows(&*resampler, samples.data(), samples.size()), samples);
}

TEST(ResamplerTest, KeepsAConstantAndTheFirstTime) {
  // A step: before it silence, behind it a constant, half-way between them at its time.
  Result<Resampler> resampler = Resampler::Make(16000, 48000);
  ASSERT_TRUE(resampler.ok());
  std::vector<float> samples(4000, 0.5f);
  const std::vector<float> out = AllRows(&*resampler, samples.data(), samples.size());
  ASSERT_EQ(out.size(), 12000u);
  EXPECT_NEAR(out[6000], 0.5f, 1e-6f);
  EXPECT_NEAR(out[0], 0.5f * (0.5f + 0.95f / 2), 1e-3f);  // the step lies half a sample before it
}

TEST(ResamplerTest, KeepsStepWithTime) {
  // Ten hours in steps that skip almost everything: the count of rows is what exact arithmetic
  // says.
  Result<Resampler> made = Resampler::Make(44101, 1000);
  ASSERT_TRUE(made.ok());
  const std::size_t piece = 1 << 16;
  const std::vector<float> silence(piece);
  std::vector<float> rows(std::max(made->MaxRows(piece), made->MaxRowsAtFinish()));
  std::size_t samples = 0, written = 0;
  for (int i = 0; i < 150; ++i, samples += piece) {
    written += made->Push(silence.data(), piece, rows.data());
  }
  written += made->Finish(rows.data());
  EXPECT_EQ(written, (samples * 1000 + 44100) / 44101);
}

}  // namespace
}  // namespace gestus::audio
