// The loudness of frames of sound in bands of the ERB scale: the square root of the magnitude
// spectrum there, by a spline between the bins.  A private header of SWIPE'.
#ifndef GESTUS_MODELS_PROSODY_LOUDNESS_H_
#define GESTUS_MODELS_PROSODY_LOUDNESS_H_

#include <cstddef>
#include <vector>

#include "models/audio/fft.h"
#include "models/prosody/swipe.h"

namespace gestus::prosody {

/// Four spectra are worked on side by side: each recurrence along the bins waits for itself, and
/// four of them wait no longer than one.
inline constexpr std::size_t kLanes = 4;

/// Cubic splines through values at 0, spacing, 2 spacing, ..., read at fixed places.
class LaneSpline {
 public:
  LaneSpline(std::size_t knots, double spacing, const std::vector<double>& places, SwipeMode mode);

  std::size_t knots() const { return ratio_.size(); }
  /// `values` (knots, kLanes) to `out` (places, kLanes).
  void Read(const double* values, double* out);

 private:
  // Between knots i and i + 1: value = a y[i] + b y[i + 1] + bend(z[i], z[i + 1]), z being the
  // second derivatives times spacing^2.
  struct Place {
    std::size_t knot;
    double a, b, bend_a, bend_b;
  };

  void Solve(const double* values);

  SwipeMode mode_;
  double spacing_;
  std::vector<double> ratio_, pivot_;  // of the elimination, the same for all values
  std::vector<double> z_;              // (knots, kLanes)
  std::vector<Place> places_;
};

/// Hann frames of one size, each half a frame after the one before.
class Loudness {
 public:
  Loudness(std::size_t size, double sample_rate, const std::vector<double>& bands, SwipeMode mode);

  /// `frames` frames, the first of which begins at samples[0], to `rows` (frames, bands), each of
  /// norm 1.  A frame of silence, or with a sample that is not finite, gives zeros.
  void Rows(const float* samples, std::size_t frames, double* rows);

 private:
  void Spectrum(const float* samples, std::size_t lane);

  std::size_t size_, bands_;
  std::vector<double> hann_, frame_, power_;
  std::vector<double> magnitudes_, loudness_;  // (.., kLanes)
  audio::RealFft<double> fft_;
  LaneSpline spline_;
};

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_LOUDNESS_H_
