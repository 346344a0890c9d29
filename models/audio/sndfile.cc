#include "models/audio/sndfile.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gestus::audio {
namespace {

constexpr std::size_t kPieceSamples = 16384;

struct Closer {
  void operator()(SNDFILE* file) const { ::sf_close(file); }
};

// What the library says, without the full stop that it may put there.
std::string Sentence(const char* text) {
  std::string sentence = text;
  while (!sentence.empty() && sentence.back() == '.') sentence.pop_back();
  return sentence;
}

class SndfileSource final : public AudioSource {
 public:
  SndfileSource(InputFile file, SNDFILE* sound, const SF_INFO& info)
      : file_(std::move(file)), sound_(sound) {
    sample_rate_ = info.samplerate;
    channels_ = info.channels;
    // The library stands in a huge number for a length that it does not know.
    frames_ = info.frames >= 0 && info.frames < SF_COUNT_MAX ? info.frames : -1;
    if (frames_ == 0) notes_.push_back("holds no samples");
    const auto channels = static_cast<std::size_t>(channels_);
    samples_.resize(std::max(kPieceSamples / channels, std::size_t{1}) * channels);
  }

  Result<std::size_t> Read(float* mono, std::size_t n) override {
    const auto channels = static_cast<std::size_t>(channels_);
    std::size_t written = 0;
    while (written < n) {
      const std::size_t frames = std::min(n - written, samples_.size() / channels);
      const sf_count_t got =
          ::sf_readf_float(sound_.get(), samples_.data(), static_cast<sf_count_t>(frames));
      if (got <= 0) {
        if (const int error = ::sf_error(sound_.get()); error != SF_ERR_NO_ERROR && !told_) {
          told_ = true;
          notes_.push_back("is damaged: " + Sentence(::sf_error_number(error)));
        }
        break;
      }
      Mix(static_cast<std::size_t>(got), mono + written);
      written += static_cast<std::size_t>(got);
    }
    return written;
  }

 private:
  void Mix(std::size_t frames, float* mono) {
    std::uint64_t not_finite = 0;
    const float* sample = samples_.data();
    for (std::size_t i = 0; i < frames; ++i) {
      double sum = 0;
      for (int c = 0; c < channels_; ++c, ++sample) {
        if (std::isfinite(*sample)) {
          sum += static_cast<double>(*sample);
        } else {
          ++not_finite;
        }
      }
      mono[i] = static_cast<float>(sum / channels_);
    }
    if (not_finite > 0) NoteNotFinite(not_finite);
  }

  InputFile file_;  // which sound_ reads from
  std::unique_ptr<SNDFILE, Closer> sound_;
  std::vector<float> samples_;
  bool told_ = false;
};

}  // namespace

Result<std::unique_ptr<AudioSource>> OpenSndfile(const std::string& path, InputFile file) {
  SF_INFO info = {};
  SNDFILE* sound = ::sf_open_fd(file.fd.get(), SFM_READ, &info, /*close_desc=*/0);
  if (sound == nullptr) {
    return Status(Code::kBadInput, path + ": is no sound file that libsndfile can read (" +
                                       Sentence(::sf_strerror(nullptr)) +
                                       "), expected WAV, FLAC, OGG or MP3");
  }
  std::unique_ptr<SNDFILE, Closer> guard(sound);
  if (info.samplerate <= 0 || info.channels <= 0) {
    return Status(Code::kBadInput, path + ": " + std::to_string(info.channels) + " channels at " +
                                       std::to_string(info.samplerate) + " Hz, expected some");
  }
  return std::unique_ptr<AudioSource>(
      std::make_unique<SndfileSource>(std::move(file), guard.release(), info));
}

}  // namespace gestus::audio
