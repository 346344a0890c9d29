// Recordings as streams of mono samples, whatever file they come from.
#ifndef GESTUS_MODELS_AUDIO_SOURCE_H_
#define GESTUS_MODELS_AUDIO_SOURCE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"

namespace gestus::audio {

/// A recording that is read once, from its begin to its end, in pieces; memory does not grow with
/// its length.
class AudioSource {
 public:
  virtual ~AudioSource() = default;
  AudioSource(const AudioSource&) = delete;
  AudioSource& operator=(const AudioSource&) = delete;

  int sample_rate() const { return sample_rate_; }  ///< Hz, more than 0; not all suit every stage
  int channels() const { return channels_; }        ///< of the file; Read() gives their mean
  /// Samples of each channel; -1 when only the end of the file will tell.
  std::int64_t frames() const { return frames_; }
  /// What was odd but did not keep the file from being read, a line each.  Complete when Read() has
  /// returned 0.
  const std::vector<std::string>& notes() const { return notes_; }

  /// The next `n` samples, full scale being [-1, 1]; fewer at the end of the recording and 0 behind
  /// it.  Samples that are not finite numbers become 0.  The error begins with the path.
  virtual Result<std::size_t> Read(float* mono, std::size_t n) = 0;

 protected:
  AudioSource() = default;
  /// Keeps one note on the samples that became 0.
  void NoteNotFinite(std::uint64_t count);

  int sample_rate_ = 0;
  int channels_ = 0;
  std::int64_t frames_ = -1;
  std::vector<std::string> notes_;

 private:
  std::uint64_t not_finite_ = 0;
  std::size_t not_finite_note_ = 0;
};

/// Opens a regular file that is recognised by its first bytes: WAV by our own reader
/// (models/audio/wav.h), everything else, and WAV with compressed samples, by libsndfile where
/// gestus was built with it.  The error begins with the path.
Result<std::unique_ptr<AudioSource>> OpenAudio(const std::string& path);

/// Whether this build reads more than WAV.
bool HaveSndfile();

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_SOURCE_H_
