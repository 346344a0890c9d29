#include "models/audio/fbank.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "models/audio/fft.h"
#include "models/audio/framer.h"
#include "models/audio/mel_bank.h"
#include "models/audio/rates.h"

namespace gestus::audio {

struct Fbank::State {
  State(const FbankOptions& with, std::size_t frame_size, std::size_t frame_hop,
        std::size_t fft_size, MelBank mels);
  void WriteRow(const float* from, float* row);

  FbankOptions options;
  MelBank bank;
  RealFft<double> fft;
  Framer framer;
  std::size_t hop;
  std::vector<double> window, frame, power, sums;
};

Fbank::State::State(const FbankOptions& with, std::size_t frame_size, std::size_t frame_hop,
                    std::size_t fft_size, MelBank mels)
    : options(with),
      bank(std::move(mels)),
      fft(fft_size),
      framer(frame_size, frame_hop),
      hop(frame_hop),
      window(frame_size),
      frame(fft_size),
      power(fft.bins()),
      sums(bank.filters()) {
  for (std::size_t i = 0; i < frame_size; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) /
                                     static_cast<double>(frame_size - 1));
  }
}

void Fbank::State::WriteRow(const float* from, float* row) {
  double sum = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    frame[i] = static_cast<double>(from[i] - options.mean);
    sum += frame[i];
  }
  const double mean = sum / static_cast<double>(window.size());
  double before = frame[0] - mean;  // the first sample stands in for the one before it
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double sample = frame[i] - mean;
    frame[i] = window[i] * (sample - options.preemphasis * before);
    before = sample;
  }
  fft.Power(frame.data(), power.data());  // behind the window the frame stays zero
  bank.Apply(power.data(), sums.data());
  constexpr double kFloor = std::numeric_limits<float>::epsilon();
  for (std::size_t k = 0; k < sums.size(); ++k) {
    row[k] = static_cast<float>(std::log(std::max(kFloor, sums[k])));
  }
}

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
  return Fbank(
      std::make_unique<State>(options, frame, hop, fft_size,
                              MelBank::Kaldi({.sample_rate = rate,
                                              .fft_size = fft_size,
                                              .filters = static_cast<std::size_t>(options.bins),
                                              .f_min = options.f_min,
                                              .f_max = f_max})));
}

Fbank::Fbank(std::unique_ptr<State> state) : state_(std::move(state)) {}
Fbank::~Fbank() = default;
Fbank::Fbank(Fbank&&) noexcept = default;
Fbank& Fbank::operator=(Fbank&&) noexcept = default;

int Fbank::width() const { return state_->options.bins; }

std::size_t Fbank::MaxRows(std::size_t samples) const {
  return samples == 0 ? 0 : 1 + (samples - 1) / state_->hop;
}

std::size_t Fbank::Push(const float* samples, std::size_t n, float* rows) {
  std::size_t written = 0;
  state_->framer.Push(samples, n, [&](const float* frame) {
    state_->WriteRow(frame, rows + written * state_->sums.size());
    ++written;
  });
  return written;
}

std::size_t Fbank::Finish(float*) {
  state_->framer.Clear();
  return 0;
}

}  // namespace gestus::audio
