// Samples at one rate to samples at another, for any two rates.
#ifndef GESTUS_MODELS_AUDIO_RESAMPLER_H_
#define GESTUS_MODELS_AUDIO_RESAMPLER_H_

#include <cstdint>
#include <vector>

#include "engine/status.h"
#include "models/audio/stage.h"

namespace gestus::audio {

/// A windowed sinc (Kaiser) in polyphase form: linear phase, and the delay is taken out, so that
/// output sample m is the sound at m / to seconds.  n samples give ceil(n * to / from).  Outside of
/// the recording there is silence.
///
/// With N half the lower rate: flat to 0.9 N within 0.001 dB, 6 dB down at 0.95 N, at least 100 dB
/// down from N on.  Equal rates pass the samples through untouched.
///
/// There is a filter for every phase that the ratio of the rates asks for while these filters take
/// up no more than 1 MiB; beyond (44100 to 48001, say, has 48001 phases), filters for 1024 phases a
/// zero crossing, and a straight line between the outputs of two, which adds images 115 dB down.
class Resampler final : public Stage {
 public:
  /// Rates in Hz, 1000 to 384000.
  static Result<Resampler> Make(int from, int to);

  int width() const override { return 1; }
  std::size_t MaxRows(std::size_t samples) const override;
  std::size_t Push(const float* samples, std::size_t n, float* rows) override;
  std::size_t MaxRowsAtFinish() const override;
  std::size_t Finish(float* rows) override;

 private:
  Resampler(std::uint64_t from, std::uint64_t to);
  void MakeTable(double scale, std::size_t rows);
  void Restart();
  float At(const float* samples) const;
  float* Drain(float* rows);
  float* Take(const float* samples, std::size_t n, float* rows);

  // The rates without their common divisor: output m lies at input m * from_ / to_.
  std::uint64_t from_, to_;
  std::size_t half_ = 0;    // a filter reaches over so many samples to each side
  std::size_t phases_ = 0;  // filters in table_, but for the last one when interpolating
  bool interpolate_ = false;
  std::vector<float> table_;    // (phases, 2 * half_)
  std::vector<float> silence_;  // (half_)
  std::vector<float> buffer_;
  std::size_t filled_ = 0;   // samples in buffer_
  std::size_t start_ = 0;    // of the next output's first sample in buffer_
  std::uint64_t phase_ = 0;  // of the next output: 0 to to_ - 1
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_RESAMPLER_H_
