#include "models/audio/fbank.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "models/audio/rates.h"

namespace gestus::audio {

Result<Fbank> Fbank::Make(const FbankOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckRate("sample_rate", options.sample_rate));
  const auto bad = [](const std::string& sentence) {
    return Status(Code::kInvalidArgument, sentence);
  };
  if (options.bins < 4 || options.bins > 4096) {
    return bad("bins is " + std::to_string(options.bins) + ", expected 4 to 4096");
  }
  const double rate = options.sample_rate;
  const double f_max = options.f_max == 0 ? rate / 2 : options.f_max;
  if (!(options.f_min >= 0 && options.f_min < f_max && f_max <= rate / 2)) {
    return bad("f_min and f_max, expected 0 <= f_min < f_max <= half of sample_rate, " +
               std::to_string(options.sample_rate) + " Hz");
  }
  if (!(options.preemphasis >= 0 && options.preemphasis <= 1)) {
    return bad("preemphasis, expected 0 to 1");
  }
  if (!std::isfinite(options.mean)) return bad("mean, expected a finite number");
  const auto frame = static_cast<std::size_t>(options.sample_rate * 25L / 1000);
  const auto hop = static_cast<std::size_t>(options.sample_rate / 100);
  const std::size_t fft_size = std::bit_ceil(frame);
  return Fbank(options, frame, hop, fft_size,
               MelBank::Kaldi({.sample_rate = rate,
                               .fft_size = fft_size,
                               .filters = static_cast<std::size_t>(options.bins),
                               .f_min = options.f_min,
                               .f_max = f_max}));
}

Fbank::Fbank(const FbankOptions& options, std::size_t frame, std::size_t hop, std::size_t fft_size,
             MelBank bank)
    : options_(options),
      bank_(std::move(bank)),
      fft_(fft_size),
      framer_(frame, hop),
      hop_(hop),
      window_(frame),
      frame_(fft_size),
      power_(fft_.bins()),
      sums_(bank_.filters()) {
  for (std::size_t i = 0; i < frame; ++i) {
    window_[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) /
                                      static_cast<double>(frame - 1));
  }
}

void Fbank::WriteRow(const float* frame, float* row) {
  double sum = 0;
  for (std::size_t i = 0; i < window_.size(); ++i) {
    frame_[i] = static_cast<double>(frame[i] - options_.mean);
    sum += frame_[i];
  }
  const double mean = sum / static_cast<double>(window_.size());
  double before = frame_[0] - mean;  // the first sample stands in for the one before it
  for (std::size_t i = 0; i < window_.size(); ++i) {
    const double sample = frame_[i] - mean;
    frame_[i] = window_[i] * (sample - options_.preemphasis * before);
    before = sample;
  }
  fft_.Power(frame_.data(), power_.data());  // behind the window frame_ stays zero
  bank_.Apply(power_.data(), sums_.data());
  constexpr double kFloor = std::numeric_limits<float>::epsilon();
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    row[k] = static_cast<float>(std::log(std::max(kFloor, sums_[k])));
  }
}

std::size_t Fbank::MaxRows(std::size_t samples) const {
  return samples == 0 ? 0 : 1 + (samples - 1) / hop_;
}

std::size_t Fbank::Push(const float* samples, std::size_t n, float* rows) {
  std::size_t written = 0;
  framer_.Push(samples, n, [&](const float* frame) {
    WriteRow(frame, rows + written * sums_.size());
    ++written;
  });
  return written;
}

std::size_t Fbank::Finish(float*) {
  framer_.Clear();
  return 0;
}

}  // namespace gestus::audio
