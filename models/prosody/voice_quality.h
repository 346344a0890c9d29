// How a voice sounds beside its pitch: jitter, shimmer, harmonic-to-noise ratio and Hammarberg
// index, by the definitions of GeMAPS (Eyben et al. 2016; thesis 4.1.2).  They describe a corpus;
// no network takes them.
#ifndef GESTUS_MODELS_PROSODY_VOICE_QUALITY_H_
#define GESTUS_MODELS_PROSODY_VOICE_QUALITY_H_

#include <cstddef>
#include <memory>

#include "engine/status.h"
#include "models/prosody/swipe.h"

namespace gestus::prosody {

struct VoiceQualityOptions {
  SwipeOptions swipe = {};       ///< sample rate at least 8,000 Hz
  double frame_seconds = 0.060;  ///< the stretch that a row describes, centred on its time
};

/// f0 and voice quality of a recording in one pass: the interface, the rows and their times are
/// those of Swipe, with four columns more.  With T_i the periods found in a frame and A_i their
/// peak-to-peak amplitudes:
///
///   0 f0, 1 strength    as by Swipe
///   2 jitter            mean |T_i - T_{i-1}| / mean T, a share
///   3 shimmer           mean |20 log10(A_{i+1} / A_i)|, dB
///   4 harmonics         10 log10(r / (1 - r)), dB from -100 to 100; r is the correlation of the
///                       frame with itself one period later, at its maximum within 10 % of 1 / f0
///   5 Hammarberg index  20 log10(max |X| in 0 to 2 kHz / max |X| in 2 to 5 kHz), dB from -100 to
///                       100, or to half the sample rate where that is below 5 kHz
///
/// Columns 2 to 4 are 0 where f0 is 0, jitter also where a frame holds fewer than two whole
/// periods, shimmer where it holds none.  A frame of silence, or with a sample that is not finite
/// in it or within a period of it, has zeros in columns 2 to 5.
class VoiceQuality {
 public:
  static constexpr std::size_t kColumns = 6;

  static Result<VoiceQuality> Make(const VoiceQualityOptions& options);
  ~VoiceQuality();
  VoiceQuality(VoiceQuality&&) noexcept;
  VoiceQuality& operator=(VoiceQuality&&) noexcept;

  const VoiceQualityOptions& options() const;
  /// As Swipe's; frames end before that.
  std::size_t Latency() const;
  std::size_t MaxRows(std::size_t n) const;
  std::size_t Push(const float* samples, std::size_t n, float* rows);
  std::size_t MaxRowsAtFinish() const;
  std::size_t Finish(float* rows);

 private:
  class Stream;
  explicit VoiceQuality(std::unique_ptr<Stream> stream);

  std::unique_ptr<Stream> stream_;
};

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_VOICE_QUALITY_H_
