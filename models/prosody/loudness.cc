#include "models/prosody/loudness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gestus::prosody {

LaneSpline::LaneSpline(std::size_t knots, double spacing, const std::vector<double>& places,
                       SwipeMode mode)
    : mode_(mode), spacing_(spacing), ratio_(knots), pivot_(knots), z_(knots * kLanes) {
  // z[i-1] + 4 z[i] + z[i+1] = 6 (y[i-1] - 2 y[i] + y[i+1]), eliminated from the left.  Ends: z = 0
  // (natural), or slopes of 2 (SPTK).
  ratio_[0] = mode == SwipeMode::kSptk ? -0.5 : 0.0;
  for (std::size_t i = 1; i < knots; ++i) {
    pivot_[i] = 1 / (0.5 * ratio_[i - 1] + 2);
    ratio_[i] = -0.5 * pivot_[i];
  }
  for (const double place : places) {
    const auto below = static_cast<std::size_t>(place / spacing);
    const std::size_t knot = std::min(below, knots - 2);
    const double b = place / spacing - static_cast<double>(knot), a = 1 - b;
    const double cubic_a = a * a * a - a, cubic_b = b * b * b - b;
    // Where the sum of the two bends should stand, SPTK has their product.
    if (mode == SwipeMode::kSptk)
      places_.push_back({knot, a, b, cubic_a * cubic_b / (6 * spacing * spacing), 0});
    else
      places_.push_back({knot, a, b, cubic_a / 6, cubic_b / 6});
  }
}

void LaneSpline::Solve(const double* y) {
  const std::size_t last = knots() - 1;
  constexpr double kSlope = 2.0;
  double carried[kLanes] = {};
  if (mode_ == SwipeMode::kSptk)
    for (std::size_t l = 0; l < kLanes; ++l)
      carried[l] = 3 * ((y[kLanes + l] - y[l]) - kSlope * spacing_);
  std::copy_n(carried, kLanes, z_.data());
  for (std::size_t i = 1; i < last; ++i) {
    const double *at = y + i * kLanes, *before = at - kLanes;
    const double half_pivot = 0.5 * pivot_[i], pivot = 3 * pivot_[i];
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double bend = (at[l + kLanes] - at[l]) - (at[l] - before[l]);
      carried[l] = pivot * bend - half_pivot * carried[l];
      z_[i * kLanes + l] = carried[l];
    }
  }
  double next[kLanes] = {};
  if (mode_ == SwipeMode::kSptk) {
    const double *at = y + last * kLanes, *before = at - kLanes;
    for (std::size_t l = 0; l < kLanes; ++l)
      next[l] = (3 * (kSlope * spacing_ - (at[l] - before[l])) - 0.5 * carried[l]) /
                (0.5 * ratio_[last - 1] + 1);
  }
  std::copy_n(next, kLanes, z_.data() + last * kLanes);
  for (std::size_t i = last; i-- > 0;) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      next[l] = ratio_[i] * next[l] + z_[i * kLanes + l];
      z_[i * kLanes + l] = next[l];
    }
  }
}

void LaneSpline::Read(const double* values, double* out) {
  Solve(values);
  for (const Place& p : places_) {
    const double* y = values + p.knot * kLanes;
    const double* z = z_.data() + p.knot * kLanes;
    if (mode_ == SwipeMode::kSptk) {
      for (std::size_t l = 0; l < kLanes; ++l)
        out[l] = p.a * y[l] + p.b * y[l + kLanes] + p.bend_a * z[l] * z[l + kLanes];
    } else {
      for (std::size_t l = 0; l < kLanes; ++l)
        out[l] = p.a * y[l] + p.b * y[l + kLanes] + p.bend_a * z[l] + p.bend_b * z[l + kLanes];
    }
    out += kLanes;
  }
}

Loudness::Loudness(std::size_t size, double sample_rate, const std::vector<double>& bands,
                   SwipeMode mode)
    : size_(size),
      bands_(bands.size()),
      hann_(size),
      frame_(size),
      power_(size / 2 + 1),
      magnitudes_((size / 2 + 1) * kLanes),
      loudness_(bands.size() * kLanes),
      fft_(size),
      // SPTK leaves the bin at half the sample rate out.
      spline_(size / 2 + (mode == SwipeMode::kSptk ? 0 : 1),
              sample_rate / static_cast<double>(size), bands, mode) {
  for (std::size_t i = 0; i < size; ++i)
    hann_[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) /
                                    static_cast<double>(size));
}

void Loudness::Spectrum(const float* samples, std::size_t lane) {
  for (std::size_t i = 0; i < size_; ++i) frame_[i] = hann_[i] * double{samples[i]};
  fft_.Power(frame_.data(), power_.data());
  for (std::size_t i = 0; i < spline_.knots(); ++i)
    magnitudes_[i * kLanes + lane] = std::sqrt(power_[i]);
}

void Loudness::Rows(const float* samples, std::size_t frames, double* rows) {
  for (std::size_t first = 0; first < frames; first += kLanes) {
    const std::size_t lanes = std::min(kLanes, frames - first);
    for (std::size_t l = 0; l < lanes; ++l) Spectrum(samples + (first + l) * size_ / 2, l);
    spline_.Read(magnitudes_.data(), loudness_.data());
    double energy[kLanes] = {};
    for (std::size_t b = 0; b < bands_; ++b) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        // Overshoot below zero, and what is not a number, count as nothing.
        double& value = loudness_[b * kLanes + l];
        const double magnitude = value > 0 ? value : 0;
        value = std::sqrt(magnitude);
        energy[l] += value * value;
      }
    }
    for (std::size_t l = 0; l < lanes; ++l) {
      const bool heard = energy[l] > 0 && std::isfinite(energy[l]);
      const double scale = heard ? 1 / std::sqrt(energy[l]) : 0;
      double* row = rows + (first + l) * bands_;
      for (std::size_t b = 0; b < bands_; ++b)
        row[b] = heard ? scale * loudness_[b * kLanes + l] : 0;
    }
  }
}

}  // namespace gestus::prosody
