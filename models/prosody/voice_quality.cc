// Swipe says when and how high; the samples are kept until it has said so.
#include "models/prosody/voice_quality.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/denormals.h"
#include "models/prosody/range.h"
#include "models/prosody/voice_frame.h"

namespace gestus::prosody {

class VoiceQuality::Stream {
 public:
  Stream(const VoiceQualityOptions& options, Swipe swipe)
      : options_(options),
        swipe_(std::move(swipe)),
        frame_(options.swipe.sample_rate,
               static_cast<std::size_t>(options.frame_seconds * options.swipe.sample_rate),
               options.swipe.min_hz) {
    const double size = options.frame_seconds * options.swipe.sample_rate;
    half_ = static_cast<std::size_t>(size) / 2 + frame_.context();
    // Swipe gives rows of times up to its latency and one piece back.
    piece_ = swipe_.Latency() / 2;
    kept_ = swipe_.Latency() + piece_ + 2 * half_ + 2;
    samples_.resize(kept_ + 8 * piece_);
    pitch_.resize(std::max(swipe_.MaxRows(piece_), swipe_.MaxRowsAtFinish()) * Swipe::kColumns);
    Reset();
  }

  const VoiceQualityOptions& options() const { return options_; }
  const Swipe& swipe() const { return swipe_; }
  std::size_t Push(const float* samples, std::size_t n, float* rows) {
    const FlushDenormals flush;
    std::size_t written = 0;
    while (n > 0) {
      const std::size_t part = std::min(n, piece_);
      Keep(samples, part);
      const std::size_t count = swipe_.Push(samples, part, pitch_.data());
      Measure(count, rows + written * kColumns);
      written += count;
      samples += part;
      n -= part;
    }
    return written;
  }

  std::size_t Finish(float* rows) {
    const FlushDenormals flush;
    const std::size_t count = swipe_.Finish(pitch_.data());
    Keep(nullptr, half_ + 1);
    Measure(count, rows);
    Reset();
    return count;
  }

 private:
  // Before the first sample lies silence.
  void Reset() {
    std::fill_n(samples_.data(), half_ + 1, 0.0f);
    filled_ = half_ + 1;
    first_ = -static_cast<std::int64_t>(filled_);
    next_row_ = 0;
  }

  // Null samples are silence.
  void Keep(const float* samples, std::size_t n) {
    if (filled_ + n > samples_.size()) {
      const std::size_t old = filled_ - kept_;
      std::copy_n(samples_.data() + old, kept_, samples_.data());
      filled_ = kept_;
      first_ += static_cast<std::int64_t>(old);
    }
    if (samples != nullptr)
      std::copy_n(samples, n, samples_.data() + filled_);
    else
      std::fill_n(samples_.data() + filled_, n, 0.0f);
    filled_ += n;
  }

  void Measure(std::size_t count, float* rows) {
    const double hop = options_.swipe.hop_seconds * options_.swipe.sample_rate;
    for (std::size_t i = 0; i < count; ++i, ++next_row_, rows += kColumns) {
      const auto middle =
          static_cast<std::int64_t>(std::lround(static_cast<double>(next_row_) * hop));
      const auto begin = middle - static_cast<std::int64_t>(half_) - first_;
      rows[0] = pitch_[i * Swipe::kColumns];
      rows[1] = pitch_[i * Swipe::kColumns + 1];
      const FrameQuality q = frame_.Measure(samples_.data() + begin, double{rows[0]});
      rows[2] = static_cast<float>(q.jitter);
      rows[3] = static_cast<float>(q.shimmer);
      rows[4] = static_cast<float>(q.harmonics);
      rows[5] = static_cast<float>(q.hammarberg);
    }
  }

  const VoiceQualityOptions options_;
  Swipe swipe_;
  VoiceFrame frame_;
  std::size_t half_ = 0;   // samples on each side of a row's time
  std::size_t piece_ = 0;  // samples that Swipe gets at a time
  std::size_t kept_ = 0;   // samples that rows to come may need
  std::vector<float> samples_, pitch_;
  std::size_t filled_ = 0;
  std::int64_t first_ = 0;  // the number of samples_[0] in the recording
  std::int64_t next_row_ = 0;
};

VoiceQuality::VoiceQuality(std::unique_ptr<Stream> stream) : stream_(std::move(stream)) {}
VoiceQuality::~VoiceQuality() = default;
VoiceQuality::VoiceQuality(VoiceQuality&&) noexcept = default;
VoiceQuality& VoiceQuality::operator=(VoiceQuality&&) noexcept = default;

Result<VoiceQuality> VoiceQuality::Make(const VoiceQualityOptions& options) {
  Result<Swipe> swipe = Swipe::Make(options.swipe);
  if (!swipe.ok()) return swipe.status();
  // Three periods make two differences; and a row is due half of Swipe's latency behind its time.
  const double rate = options.swipe.sample_rate, min_hz = options.swipe.min_hz;
  const double shortest = 3 / min_hz;
  const auto context = static_cast<double>(VoiceFrame::ContextOf(rate, min_hz));
  const double longest = 2 * (static_cast<double>(swipe->Latency() / 2) - context - 2) / rate;
  if (rate < 8000)
    return OutOfRange("sample_rate", rate, "at least 8,000 Hz for the band from 2 kHz on");
  if (longest < shortest)
    return OutOfRange("min_hz", min_hz, "less for frames of three periods at this sample rate");
  if (!(options.frame_seconds >= shortest * (1 - 1e-9) && options.frame_seconds <= longest))
    return OutOfRange("frame_seconds", options.frame_seconds,
                      Plain(shortest) + ", three periods of min_hz, to " + Plain(longest));
  auto stream = std::make_unique<Stream>(options, *std::move(swipe));
  return VoiceQuality(std::move(stream));
}

const VoiceQualityOptions& VoiceQuality::options() const { return stream_->options(); }
std::size_t VoiceQuality::Latency() const { return stream_->swipe().Latency(); }
std::size_t VoiceQuality::MaxRows(std::size_t n) const { return stream_->swipe().MaxRows(n); }
std::size_t VoiceQuality::Push(const float* samples, std::size_t n, float* rows) {
  return stream_->Push(samples, n, rows);
}
std::size_t VoiceQuality::MaxRowsAtFinish() const { return stream_->swipe().MaxRowsAtFinish(); }
std::size_t VoiceQuality::Finish(float* rows) { return stream_->Finish(rows); }

}  // namespace gestus::prosody
