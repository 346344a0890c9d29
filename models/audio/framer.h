// Cuts a stream of samples into overlapping frames.  A private header of the front ends.
#ifndef GESTUS_MODELS_AUDIO_FRAMER_H_
#define GESTUS_MODELS_AUDIO_FRAMER_H_

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gestus::audio {

/// Frames of `size` samples, each `hop` <= `size` samples after the one before it.
class Framer {
 public:
  Framer(std::size_t size, std::size_t hop) : buffer_(size), hop_(hop) {}

  /// Calls use(frame) for every frame that the samples complete.
  template <class Use>
  void Push(const float* samples, std::size_t n, const Use& use) {
    while (n > 0) {
      const std::size_t take = std::min(n, buffer_.size() - filled_);
      std::copy_n(samples, take, buffer_.data() + filled_);
      filled_ += take;
      samples += take;
      n -= take;
      if (filled_ < buffer_.size()) return;
      use(static_cast<const float*>(buffer_.data()));
      std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(hop_), buffer_.end(),
                buffer_.begin());
      filled_ -= hop_;
    }
  }

  /// The end of the newest samples; once there was a frame, at least size - hop lie before it.
  const float* end() const { return buffer_.data() + filled_; }
  void Clear() { filled_ = 0; }

 private:
  std::vector<float> buffer_;
  std::size_t hop_;
  std::size_t filled_ = 0;
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_FRAMER_H_
