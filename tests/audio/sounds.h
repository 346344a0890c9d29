// Sounds and ways to run stages that the tests of models/audio share.
#ifndef GESTUS_TESTS_AUDIO_SOUNDS_H_
#define GESTUS_TESTS_AUDIO_SOUNDS_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "models/audio/stage.h"

namespace gestus::audio {

/// Noise in [-1, 1).
inline std::vector<float> Noise(std::size_t n, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::vector<float> samples(n);
  for (float& sample : samples) sample = static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f;
  return samples;
}

/// Pushes pieces of the sizes that next() gives and checks every promise about numbers of rows.
template <class Next>
std::vector<float> RunInPieces(Stage* stage, const std::vector<float>& samples, const Next& next) {
  const auto width = static_cast<std::size_t>(stage->width());
  constexpr float kPoison = 12345.0f;
  std::vector<float> all;
  const auto keep = [&](std::size_t most, auto write) {
    std::vector<float> rows(most * width + 1, kPoison);
    const std::size_t n = write(rows.data());
    EXPECT_LE(n, most);
    EXPECT_EQ(rows[n * width], kPoison) << "wrote more rows than it says";
    all.insert(all.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(n * width));
  };
  for (std::size_t at = 0; at < samples.size();) {
    const std::size_t n = std::min(next(), samples.size() - at);
    keep(stage->MaxRows(n), [&](float* rows) { return stage->Push(&samples[at], n, rows); });
    at += n;
  }
  keep(stage->MaxRowsAtFinish(), [&](float* rows) { return stage->Finish(rows); });
  return all;
}

}  // namespace gestus::audio

#endif  // GESTUS_TESTS_AUDIO_SOUNDS_H_
