// What all stages promise: pieces of any size give the same bytes, in as many rows as announced,
// and a finished stage is as new.  Values are compared with references in features_test.py.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "models/audio/fbank.h"
#include "models/audio/log_mel.h"
#include "models/audio/resampler.h"
#include "models/audio/rows.h"
#include "tests/audio/sounds.h"

namespace gestus::audio {
namespace {

struct Case {
  std::string name;
  std::function<std::unique_ptr<Stage>()> make;
  std::size_t samples;
  std::function<std::size_t(std::size_t)> rows;  // by the definition
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

template <class T>
std::unique_ptr<Stage> Own(Result<T> stage) {
  EXPECT_TRUE(stage.ok()) << stage.status().message();
  return stage.ok() ? std::make_unique<T>(*std::move(stage)) : nullptr;
}

Case ResamplerCase(int from, int to, std::size_t samples) {
  return {"resampler_" + std::to_string(from) + "_" + std::to_string(to),
          [=] { return Own(Resampler::Make(from, to)); }, samples,
          [=](std::size_t n) {
            const auto f = static_cast<std::size_t>(from), t = static_cast<std::size_t>(to);
            return (n * t + f - 1) / f;
          }};
}

std::vector<Case> Cases() {
  return {
      {"log_mel_512", [] { return Own(LogMel::Make(PatsLogMel512(44100))); }, 20000,
       [](std::size_t n) { return n == 0 ? 0 : 1 + n / 512; }},
      {"log_mel_400", [] { return Own(LogMel::Make(PatsLogMel400())); }, 5000,
       [](std::size_t n) { return n < 512 ? 0 : 1 + (n - 512) / 160; }},
      {"log_mel_small",
       [] {
         return Own(LogMel::Make({.sample_rate = 1000,
                                  .fft_size = 30,
                                  .window_size = 17,
                                  .hop = 14,
                                  .mels = 3,
                                  .f_min = 10}));
       },
       1000, [](std::size_t n) { return n == 0 ? 0 : 1 + n / 14; }},
      {"fbank", [] { return Own(Fbank::Make()); }, 5000,
       [](std::size_t n) { return n < 400 ? 0 : 1 + (n - 400) / 160; }},
      {"fbank_11025", [] { return Own(Fbank::Make({.sample_rate = 11025})); }, 5000,
       [](std::size_t n) { return n < 275 ? 0 : 1 + (n - 275) / 110; }},
      ResamplerCase(44100, 16000, 5000),
      ResamplerCase(16000, 44100, 3000),
      ResamplerCase(8000, 16000, 3000),
      ResamplerCase(44100, 48001, 3000),
      ResamplerCase(48001, 44100, 3000),
      ResamplerCase(383999, 1000, 60000),
      ResamplerCase(1000, 383999, 50),
      ResamplerCase(384000, 1000, 60000),
      ResamplerCase(16000, 16000, 1000),
  };
}

class StageTest : public testing::TestWithParam<Case> {};

TEST_P(StageTest, PiecesGiveTheSameBytes) {
  const Case& c = GetParam();
  const std::unique_ptr<Stage> stage = c.make();
  ASSERT_NE(stage, nullptr);
  std::mt19937 random(7);
  for (int round = 0; round < 12; ++round) {
    const std::size_t n = round < 3 ? c.samples : random() % c.samples;
    const std::vector<float> samples = Noise(n, 1);
    const std::vector<float> whole = AllRows(c.make().get(), samples.data(), n);
    ASSERT_EQ(whole.size(), c.rows(n) * static_cast<std::size_t>(stage->width())) << n;
    const std::size_t largest = round == 0 ? 1 : round == 1 ? n : 1 + random() % 4000;
    // The same stage again and again: Finish() must leave nothing behind.
    const std::vector<float> pieces = RunInPieces(
        stage.get(), samples, [&] { return round < 2 ? largest : random() % (largest + 1); });
    ASSERT_EQ(pieces.size(), whole.size());
    ASSERT_EQ(std::memcmp(pieces.data(), whole.data(), whole.size() * sizeof(float)), 0)
        << n << " samples in pieces of up to " << largest;
  }
}

TEST_P(StageTest, ShortRecordings) {
  const Case& c = GetParam();
  const std::unique_ptr<Stage> stage = c.make();
  const std::vector<float> samples = Noise(2100);
  for (std::size_t n = 0; n <= samples.size(); n += n < 40 ? 1 : 171) {
    const std::vector<float> rows = AllRows(stage.get(), samples.data(), n);
    ASSERT_EQ(rows.size(), c.rows(n) * static_cast<std::size_t>(stage->width())) << n;
    for (const float value : rows) ASSERT_TRUE(std::isfinite(value)) << n;
  }
}

TEST_P(StageTest, OneBadSampleSpoilsNoOtherFrames) {
  const Case& c = GetParam();
  const std::unique_ptr<Stage> stage = c.make();
  std::vector<float> samples = Noise(c.samples);
  const std::vector<float> good = AllRows(stage.get(), samples.data(), samples.size());
  samples[c.samples / 3] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> bad = AllRows(stage.get(), samples.data(), samples.size());
  const std::vector<float> after = AllRows(stage.get(), Noise(c.samples).data(), samples.size());
  ASSERT_EQ(bad.size(), good.size());
  EXPECT_NE(std::memcmp(bad.data(), good.data(), good.size() * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(after.data(), good.data(), good.size() * sizeof(float)), 0);
  // The last rows lie far behind it, but for filters as long as the recording.
  if (c.name != "resampler_384000_1000" && c.name != "resampler_383999_1000" &&
      c.name != "resampler_1000_383999") {
    EXPECT_EQ(bad.back(), good.back());
  }
}

INSTANTIATE_TEST_SUITE_P(All, StageTest, testing::ValuesIn(Cases()),
                         [](const auto& test) { return test.param.name; });

TEST(StageOptionsTest, SaysWhatIsWrong) {
  const auto error = [](const auto& stage) { return stage.status().message(); };
  EXPECT_EQ(error(LogMel::Make(PatsLogMel512(0))), "sample_rate is 0 Hz, expected 1000 to 384000");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .fft_size = 2047})),
            "fft_size is 2047, expected an even number of 4 to 65536");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .window_size = 2049})),
            "window_size is 2049, expected 1 to fft_size");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .hop = 1024})),
            "hop is 1024, expected 1 to 1023");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .hop = 0})), "hop is 0, expected 1 to 1023");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .mels = 0})),
            "mels is 0, expected 1 to 4096");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .f_max = 8001})),
            "f_min and f_max, expected 0 <= f_min < f_max <= half of sample_rate, 16000 Hz");
  EXPECT_EQ(error(LogMel::Make({.sample_rate = 16000, .floor = 0})), "floor, expected more than 0");
  EXPECT_EQ(error(Fbank::Make({.sample_rate = 999})),
            "sample_rate is 999 Hz, expected 1000 to 384000");
  EXPECT_EQ(error(Fbank::Make({.bins = 3})), "bins is 3, expected 4 to 4096");
  EXPECT_EQ(error(Fbank::Make({.f_min = 8000})),
            "f_min and f_max, expected 0 <= f_min < f_max <= half of sample_rate, 16000 Hz");
  EXPECT_EQ(error(Fbank::Make({.preemphasis = 1.5})), "preemphasis, expected 0 to 1");
  EXPECT_EQ(error(Fbank::Make({.mean = std::numeric_limits<float>::infinity()})),
            "mean, expected a finite number");
  EXPECT_EQ(error(Resampler::Make(999, 16000)),
            "the rate to resample from is 999 Hz, expected 1000 to 384000");
  EXPECT_EQ(error(Resampler::Make(16000, 384001)),
            "the rate to resample to is 384001 Hz, expected 1000 to 384000");
}

}  // namespace
}  // namespace gestus::audio
