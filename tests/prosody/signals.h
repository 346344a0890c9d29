// Sounds of known pitch and quality.
#ifndef GESTUS_TESTS_PROSODY_SIGNALS_H_
#define GESTUS_TESTS_PROSODY_SIGNALS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace gestus::prosody::test {

using Samples = std::vector<float>;

inline constexpr double kTurn = 2 * std::numbers::pi;

/// Harmonics [first, last] of `hz(t)`, amplitude 0.3 / k^slope, those below 6 kHz and 0.45 of
/// the rate.
inline Samples Harmonics(double rate, double seconds, const std::function<double(double)>& hz,
                         int first = 1, int last = 1000, double slope = 1) {
  Samples x(static_cast<std::size_t>(rate * seconds));
  const double top = std::min(6000.0, 0.45 * rate);
  double phase = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double f = hz(static_cast<double>(i) / rate);
    double sum = 0;
    for (int k = first; k <= last && k * f < top; ++k)
      sum += std::cos(k * phase + k * k) / std::pow(k, slope);
    x[i] = static_cast<float>(0.3 * sum);
    phase = std::fmod(phase + kTurn * f / rate, kTurn);
  }
  return x;
}

inline Samples Tone(double rate, double seconds, double hz) {
  return Harmonics(rate, seconds, [hz](double) { return hz; });
}

inline Samples Noise(std::size_t n, double deviation) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, deviation);
  Samples x(n);
  for (float& v : x) v = static_cast<float>(normal(random));
  return x;
}

/// Pulses, smooth enough to have nothing above 3 kHz, of which every second one comes a share
/// `jitter` later and is by `shimmer` softer.
inline Samples Pulses(double rate, double seconds, double hz, double jitter, double shimmer) {
  Samples x(static_cast<std::size_t>(rate * seconds));
  double time = 0;
  for (int n = 0; time < seconds; ++n) {
    const double odd = n % 2 == 0 ? 1 : -1;
    time += (1 + odd * jitter) / hz;
    const auto begin = static_cast<std::size_t>(std::max(0.0, (time - 0.004) * rate));
    const auto end = static_cast<std::size_t>((time + 0.004) * rate);
    for (std::size_t i = begin; i < std::min(end, x.size()); ++i) {
      const double u = static_cast<double>(i) / rate - time;
      const double width = u / 0.0007;
      x[i] += static_cast<float>(0.3 * (1 + odd * shimmer) * std::exp(-width * width) *
                                 std::cos(kTurn * 700 * u));
    }
  }
  return x;
}

/// All rows of a stage, the samples pushed `piece` at a time.
template <class Stage>
Samples Rows(Stage& stage, const Samples& x, std::size_t piece = 1 << 20) {
  Samples rows, part;
  const auto append = [&](std::size_t count) {
    rows.insert(rows.end(), part.begin(),
                part.begin() + static_cast<std::ptrdiff_t>(count * Stage::kColumns));
  };
  for (std::size_t at = 0; at < x.size(); at += piece) {
    const std::size_t n = std::min(piece, x.size() - at);
    part.resize(stage.MaxRows(n) * Stage::kColumns);
    // Exactly as large as the piece, so that a sanitizer sees a sample read past its end.
    const Samples copy(x.begin() + static_cast<std::ptrdiff_t>(at),
                       x.begin() + static_cast<std::ptrdiff_t>(at + n));
    append(stage.Push(copy.data(), n, part.data()));
  }
  part.resize(stage.MaxRowsAtFinish() * Stage::kColumns);
  append(stage.Finish(part.data()));
  return rows;
}

}  // namespace gestus::prosody::test

#endif  // GESTUS_TESTS_PROSODY_SIGNALS_H_
