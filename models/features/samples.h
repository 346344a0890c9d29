// A recording as mono samples at the rate that a front end hears.
#ifndef GESTUS_MODELS_FEATURES_SAMPLES_H_
#define GESTUS_MODELS_FEATURES_SAMPLES_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/audio/resampler.h"
#include "models/audio/source.h"

namespace gestus::features {

/// Samples piece by piece; memory does not grow with the recording.
class Samples {
 public:
  /// Errors begin with the path.
  static Result<Samples> Open(const std::string& path, int sample_rate);

  /// The next samples, valid until the next call; none behind the end.
  Result<std::span<const float>> Next();

  /// Of the recording: known from the start, or (-1) only behind the end.
  double seconds() const;
  /// "26.7 s, 16000 Hz" and what was odd, the latter complete behind the end.
  std::string Description() const;
  const std::vector<std::string>& notes() const { return source_->notes(); }

 private:
  Samples() = default;

  std::string path_;
  int sample_rate_ = 0;
  std::unique_ptr<audio::AudioSource> source_;
  std::optional<audio::Resampler> resampler_;
  std::vector<float> piece_, resampled_;
  std::int64_t read_ = 0;
  bool ended_ = false;
};

/// How long a recording is, read to its end where its header does not say so.
Result<double> SecondsOf(const std::string& path);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_SAMPLES_H_
