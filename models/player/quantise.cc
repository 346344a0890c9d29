#include "models/player/quantise.h"

#include <algorithm>
#include <cmath>

namespace gestus::player {

std::vector<float> Finite(std::span<const float> values, std::size_t columns) {
  std::vector<float> out(values.begin(), values.end());
  for (std::size_t column = 0; column < columns; ++column) {
    float last = 0;
    for (std::size_t i = column; i < out.size(); i += columns) {
      if (std::isfinite(out[i])) {
        last = out[i];
        break;
      }
    }
    for (std::size_t i = column; i < out.size(); i += columns) {
      if (std::isfinite(out[i])) {
        last = out[i];
      } else {
        out[i] = last;
      }
    }
  }
  return out;
}

std::vector<float> DrawnValues(const outputs::Figure& figure, bool body) {
  constexpr std::int64_t kPatsNeck = 0;
  const auto columns = static_cast<std::size_t>(figure.columns());
  std::vector<float> values = Finite(figure.values, columns);
  for (float& value : values) value = std::clamp(value, -kMaxCoordinate, kMaxCoordinate);
  for (std::size_t p = 0; body && p < figure.points.size(); ++p) {
    if (figure.points[p].source != kPatsNeck) continue;
    for (std::size_t row = 0; row < values.size(); row += columns)
      values[row + p] = values[row + figure.points.size() + p] = 0;
  }
  return values;
}

Quantised Quantise(std::span<const float> values) {
  constexpr double kMost = 32767;
  Quantised out;
  if (values.empty()) return out;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  out.offset = (static_cast<double>(*low) + *high) / 2;
  out.scale = (static_cast<double>(*high) - *low) / (2 * kMost);
  out.numbers.reserve(values.size());
  for (const float value : values) {
    const double number = out.scale > 0 ? std::round((value - out.offset) / out.scale) : 0;
    out.numbers.push_back(static_cast<std::int16_t>(std::clamp(number, -kMost, kMost)));
  }
  return out;
}

Levels LevelsOf(const Sound& sound) {
  Levels levels;
  const auto rate = static_cast<std::size_t>(std::max(sound.sample_rate, 1));
  const std::size_t n = sound.samples.size();
  const auto byte = [](double level) {
    return static_cast<std::uint8_t>(std::lround(255 * std::min(level, 1.0)));
  };
  for (std::size_t piece = 0; piece * rate / Levels::kRate < n; ++piece) {
    const std::size_t begin = piece * rate / Levels::kRate;
    const std::size_t end = std::min(n, std::max(begin + 1, (piece + 1) * rate / Levels::kRate));
    double peak = 0, sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double sample = std::isfinite(sound.samples[i]) ? sound.samples[i] : 0;
      peak = std::max(peak, std::abs(sample));
      sum += sample * sample;
    }
    levels.peak.push_back(byte(peak));
    levels.rms.push_back(byte(std::sqrt(sum / static_cast<double>(end - begin))));
  }
  return levels;
}

Picture PictureOf(const Spectrogram& spectrogram) {
  Picture picture;
  if (spectrogram.values.empty()) return picture;
  const std::vector<float> values =
      Finite(spectrogram.values, static_cast<std::size_t>(spectrogram.bins));
  const std::int64_t rows = static_cast<std::int64_t>(values.size()) / spectrogram.bins;
  // The background is what a third of the picture stays below.
  std::vector<float> sorted = values;
  const auto percentile = [&](double share) {
    const auto at = sorted.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    return static_cast<double>(*at);
  };
  const double low = percentile(0.35), high = percentile(0.995);
  const std::int64_t rows_each = (rows + kMaxPictureRows - 1) / kMaxPictureRows;
  const std::int64_t bins_each = (spectrogram.bins + kMaxBins - 1) / kMaxBins;
  picture.rate = spectrogram.rate / static_cast<double>(rows_each);
  picture.bins = (spectrogram.bins + bins_each - 1) / bins_each;
  for (std::int64_t row = 0; row < rows; row += rows_each) {
    for (std::int64_t bin = 0; bin < spectrogram.bins; bin += bins_each) {
      double sum = 0;
      int count = 0;
      for (std::int64_t r = row; r < std::min(rows, row + rows_each); ++r) {
        for (std::int64_t b = bin; b < std::min(spectrogram.bins, bin + bins_each); ++b, ++count)
          sum += values[static_cast<std::size_t>(r * spectrogram.bins + b)];
      }
      const double share = high > low ? (sum / count - low) / (high - low) : 0;
      picture.values.push_back(
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
    }
  }
  return picture;
}

}  // namespace gestus::player
