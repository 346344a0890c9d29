// The filter bank features of AST (Gong et al. 2021): Kaldi's, as torchaudio.compliance.kaldi.fbank
// computes them for AST's data loader.
#ifndef GESTUS_MODELS_AUDIO_FBANK_H_
#define GESTUS_MODELS_AUDIO_FBANK_H_

#include <cstddef>
#include <memory>

#include "engine/status.h"
#include "models/audio/stage.h"

namespace gestus::audio {

struct FbankOptions {
  int sample_rate = 16000;  ///< Hz; AST takes no other
  int bins = 128;
  double f_min = 20;  ///< Hz
  double f_max = 0;   ///< Hz; 0 stands for half the sample rate
  double preemphasis = 0.97;
  /// Taken off every sample, in float32 as by AST's loader.  That takes the mean of the whole
  /// recording, which a stream does not know.  Little is lost without it: each frame's own mean is
  /// taken off next, and with it every constant; only roundings differ, by less than 1e-3 on
  /// speech.
  float mean = 0;
};

/// Rows (bins): ln of the sums of mel filters over the power spectrum, at least 2^-23, of frames of
/// 25 ms every 10 ms.  Samples are in [-1, 1].  n samples give 1 + (n - frame) / hop rows, none
/// when they do not fill a frame; Finish() never adds one. The values are those before AST's (x -
/// mean) / (2 * deviation), which is part of the network.
class Fbank final : public Stage {
 public:
  static Result<Fbank> Make(const FbankOptions& options = {});
  ~Fbank() override;
  Fbank(Fbank&&) noexcept;
  Fbank& operator=(Fbank&&) noexcept;

  int width() const override;
  std::size_t MaxRows(std::size_t samples) const override;
  std::size_t Push(const float* samples, std::size_t n, float* rows) override;
  std::size_t MaxRowsAtFinish() const override { return 0; }
  std::size_t Finish(float* rows) override;

 private:
  struct State;
  explicit Fbank(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_FBANK_H_
