// Voice quality of one frame of sound, its f0 being known.  A private header.
#ifndef GESTUS_MODELS_PROSODY_VOICE_FRAME_H_
#define GESTUS_MODELS_PROSODY_VOICE_FRAME_H_

#include <cstddef>
#include <vector>

#include "models/audio/fft.h"

namespace gestus::prosody {

/// Where a sequence is highest between its values, and how high.
struct Peak {
  double place = 0, value = 0;
};

/// Finds peaks between samples by windowed sinc interpolation.
class PeakFinder {
 public:
  static constexpr std::size_t kReach = 16;  ///< values that are read on both sides

  PeakFinder();
  /// The highest point of sign * y within one of `at`; y[at - kReach] to y[at + kReach] are read.
  Peak Near(const double* y, std::size_t at, double sign = 1) const;

 private:
  static constexpr int kFine = 8;  // steps between two values
  std::vector<double> weights_;    // (2 kFine + 1, 2 kReach + 1)
};

struct FrameQuality {
  double jitter = 0, shimmer = 0, harmonics = 0, hammarberg = 0;
};

class VoiceFrame {
 public:
  /// Frames of `frame` samples of voices not below `min_hz`.
  VoiceFrame(double sample_rate, std::size_t frame, double min_hz);

  /// Samples on each side of a frame that are looked at beside it.
  static std::size_t ContextOf(double sample_rate, double min_hz);
  std::size_t context() const { return context_; }
  /// `samples`: context(), the frame, context().  `hz` is 0 for an unvoiced frame.
  FrameQuality Measure(const float* samples, double hz);

 private:
  bool Load(const float* samples);
  double Correlation(std::size_t a, std::size_t b, std::size_t n) const;
  Peak HighestCorrelation(std::size_t a, std::size_t n, int direction, double low, double high);
  void FindMarks(double period);
  void Step(double period, double start, int direction);
  double Amplitude(double mark, double period) const;
  double Harmonics(double period);
  double Hammarberg();
  double PeakLevel(std::size_t begin, std::size_t end) const;

  const double sample_rate_, min_hz_;
  const std::size_t frame_, context_;
  const PeakFinder peaks_;
  audio::RealFft<double> fft_;
  std::vector<double> x_;        // the samples, without the frame's mean
  std::vector<double> squares_;  // sums of their squares from the first on
  std::vector<double> hann_, windowed_, power_;
  std::vector<double> correlations_;
  std::vector<double> marks_;  // one in each period, at the same place of its waveform; samples
};

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_VOICE_FRAME_H_
