// The logarithm of mel power as PATS computed it with librosa (Ahuja et al. 2020,
// data/audio.py of chahuja/pats; McFee et al. 2015, librosa.feature.melspectrogram before 0.10).
#ifndef GESTUS_MODELS_AUDIO_LOG_MEL_H_
#define GESTUS_MODELS_AUDIO_LOG_MEL_H_

#include <cstddef>
#include <memory>

#include "engine/status.h"
#include "models/audio/stage.h"

namespace gestus::audio {

struct LogMelOptions {
  int sample_rate = 0;     ///< Hz, 1000 to 384000
  int fft_size = 2048;     ///< samples of a frame, even
  int window_size = 2048;  ///< periodic Hann in the middle of the frame, zeros around it
  int hop = 512;           ///< samples from row to row
  bool center = true;      ///< row r is about sample r * hop; else it begins there
  bool power = true;       ///< |X|^2; else |X|
  int mels = 128;
  double f_min = 0;  ///< Hz
  double f_max = 0;  ///< Hz; 0 stands for half the sample rate
  bool slaney_norm = true;
  double floor = 1e-10;  ///< replaces sums that are exactly zero
};

/// PATS' audio/log_mel_512 of a recording, at the rate that the recording has.
LogMelOptions PatsLogMel512(int sample_rate);
/// PATS' audio/log_mel_400, which hears everything at 16 kHz.
LogMelOptions PatsLogMel400();

/// Rows (mels): ln of the sums of mel filters over the spectrum.
///
/// n samples give 1 + n / hop rows when centred, else 1 + (n - fft_size) / hop.  A centred stage
/// mirrors the recording at its first and last sample, neither repeated; one of fft_size / 2
/// samples or fewer is mirrored over and over, as numpy.pad does, a single sample is repeated, and
/// no samples give no rows.
class LogMel final : public Stage {
 public:
  static Result<LogMel> Make(const LogMelOptions& options);
  ~LogMel() override;
  LogMel(LogMel&&) noexcept;
  LogMel& operator=(LogMel&&) noexcept;

  int width() const override;
  std::size_t MaxRows(std::size_t samples) const override;
  std::size_t Push(const float* samples, std::size_t n, float* rows) override;
  std::size_t MaxRowsAtFinish() const override;
  std::size_t Finish(float* rows) override;

 private:
  struct State;
  explicit LogMel(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_LOG_MEL_H_
