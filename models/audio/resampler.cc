// The filter is designed by Kaiser's formulas (Kaiser 1974; Oppenheim & Schafer, 7.5.3): an
// attenuation of 110 dB over a transition of 0.1 N takes 144 zero crossings.
#include "models/audio/resampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "models/audio/rates.h"

namespace gestus::audio {
namespace {

constexpr std::size_t kHalfWidth = 72;  // samples at the lower rate to each side
constexpr double kCutoff = 0.95;        // of half the lower rate
constexpr double kBeta = 0.1102 * (110.0 - 8.7);
constexpr std::size_t kMaxTable = std::size_t{1} << 18;  // floats of filters for every phase
constexpr double kPhases = 1024;   // a sample at the lower rate, when interpolating
constexpr std::size_t kLane = 16;  // sums that Dot() keeps; filters are multiples of it

// The modified Bessel function of the first kind and order zero.
double Bessel(double x) {
  double sum = 1, term = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= (x / (2 * k)) * (x / (2 * k));
    sum += term;
  }
  return sum;
}

// The filter at `t`, in samples at the lower rate.
double Kernel(double t) {
  const double inside = 1 - (t / kHalfWidth) * (t / kHalfWidth);
  if (inside <= 0) return 0;
  const double angle = std::numbers::pi * kCutoff * t;
  const double sinc = t == 0 ? 1 : std::sin(angle) / angle;
  return sinc * Bessel(kBeta * std::sqrt(inside)) / Bessel(kBeta);
}

// Separate sums, so that the compiler may use vectors without reordering any of them.
float Dot(const float* a, const float* b, std::size_t n) {
  float sums[kLane] = {};
  for (std::size_t i = 0; i < n; i += kLane) {
    for (std::size_t j = 0; j < kLane; ++j) sums[j] += a[i + j] * b[i + j];
  }
  for (std::size_t width = kLane / 2; width > 0; width /= 2) {
    for (std::size_t j = 0; j < width; ++j) sums[j] += sums[j + width];
  }
  return sums[0];
}

}  // namespace

Result<Resampler> Resampler::Make(int from, int to) {
  GESTUS_RETURN_IF_ERROR(CheckRate("the rate to resample from", from));
  GESTUS_RETURN_IF_ERROR(CheckRate("the rate to resample to", to));
  const int divisor = std::gcd(from, to);
  return Resampler(static_cast<std::uint64_t>(from / divisor),
                   static_cast<std::uint64_t>(to / divisor));
}

Resampler::Resampler(std::uint64_t from, std::uint64_t to) : from_(from), to_(to) {
  if (from == to) return;
  // Going down, the filter is as wide in time as samples at the lower rate are apart.
  const double scale = std::min(1.0, static_cast<double>(to) / static_cast<double>(from));
  half_ = static_cast<std::size_t>(std::ceil(kHalfWidth / scale));
  half_ = (half_ + kLane / 2 - 1) / (kLane / 2) * (kLane / 2);
  interpolate_ = to * 2 * half_ > kMaxTable;
  phases_ = interpolate_ ? static_cast<std::size_t>(std::ceil(kPhases * scale))
                         : static_cast<std::size_t>(to);
  MakeTable(scale, phases_ + (interpolate_ ? 1 : 0));
  silence_.resize(half_);
  buffer_.resize(4 * half_ + 1024);
  Restart();
}

// Row p holds the filter for an output p / phases_ of a sample behind the middle of its samples.
// Every row sums to 1, so that a constant comes out as it went in.
void Resampler::MakeTable(double scale, std::size_t rows) {
  const std::size_t taps = 2 * half_;
  table_.resize(rows * taps);
  std::vector<double> row(taps);
  for (std::size_t p = 0; p < rows; ++p) {
    const double offset = static_cast<double>(p) / static_cast<double>(phases_);
    for (std::size_t k = 0; k < taps; ++k) {
      const double at = static_cast<double>(half_ - 1) - static_cast<double>(k);
      row[k] = Kernel(scale * (at + offset));
    }
    const double sum = std::accumulate(row.begin(), row.end(), 0.0);
    for (std::size_t k = 0; k < taps; ++k) {
      table_[p * taps + k] = static_cast<float>(row[k] / sum);
    }
  }
}

void Resampler::Restart() {
  // Silence before the first sample, so that the first output has its middle there.
  std::fill(buffer_.begin(), buffer_.end(), 0.0f);
  filled_ = half_ - 1;
  start_ = 0;
  phase_ = 0;
}

// The output at phase_ from the 2 * half_ samples it needs.
float Resampler::At(const float* samples) const {
  const std::size_t taps = 2 * half_;
  if (!interpolate_) return Dot(samples, &table_[phase_ * taps], taps);
  const std::uint64_t place = phase_ * phases_;
  const float* row = &table_[place / to_ * taps];
  const double low = Dot(samples, row, taps), high = Dot(samples, row + taps, taps);
  const double share = static_cast<double>(place % to_) / static_cast<double>(to_);
  return static_cast<float>(low + share * (high - low));
}

// Writes the outputs whose samples are there.  A step is shorter than a filter, so that start_
// never passes filled_.
float* Resampler::Drain(float* rows) {
  while (start_ + 2 * half_ <= filled_) {
    *rows++ = At(&buffer_[start_]);
    phase_ += from_;
    start_ += phase_ / to_;
    phase_ %= to_;
  }
  return rows;
}

float* Resampler::Take(const float* samples, std::size_t n, float* rows) {
  while (n > 0) {
    if (filled_ == buffer_.size()) {
      std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(start_), buffer_.end(),
                buffer_.begin());
      filled_ -= start_;
      start_ = 0;
    }
    const std::size_t take = std::min(n, buffer_.size() - filled_);
    std::copy_n(samples, take, buffer_.data() + filled_);
    filled_ += take;
    samples += take;
    n -= take;
    rows = Drain(rows);
  }
  return rows;
}

std::size_t Resampler::MaxRows(std::size_t samples) const {
  return samples == 0 ? 0 : static_cast<std::size_t>(samples * to_ / from_) + 1;
}

std::size_t Resampler::Push(const float* samples, std::size_t n, float* rows) {
  if (from_ == to_) {
    std::copy_n(samples, n, rows);
    return n;
  }
  return static_cast<std::size_t>(Take(samples, n, rows) - rows);
}

std::size_t Resampler::MaxRowsAtFinish() const { return MaxRows(half_); }

std::size_t Resampler::Finish(float* rows) {
  if (from_ == to_) return 0;
  // So much silence completes every output that lies before the end of the recording, and no other.
  const float* end = Take(silence_.data(), silence_.size(), rows);
  Restart();
  return static_cast<std::size_t>(end - rows);
}

}  // namespace gestus::audio
