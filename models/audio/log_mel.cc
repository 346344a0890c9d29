#include "models/audio/log_mel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "models/audio/rates.h"

namespace gestus::audio {
namespace {

Status Check(const LogMelOptions& o) {
  GESTUS_RETURN_IF_ERROR(CheckRate("sample_rate", o.sample_rate));
  const auto bad = [](const std::string& sentence) {
    return Status(Code::kInvalidArgument, sentence);
  };
  if (o.fft_size < 4 || o.fft_size > 65536 || o.fft_size % 2 != 0) {
    return bad("fft_size is " + std::to_string(o.fft_size) +
               ", expected an even number of 4 to 65536");
  }
  if (o.window_size < 1 || o.window_size > o.fft_size) {
    return bad("window_size is " + std::to_string(o.window_size) + ", expected 1 to fft_size");
  }
  // Mirroring takes the last samples from what the frames leave behind.
  const int max_hop = o.center ? o.fft_size / 2 - 1 : o.fft_size;
  if (o.hop < 1 || o.hop > max_hop) {
    return bad("hop is " + std::to_string(o.hop) + ", expected 1 to " + std::to_string(max_hop));
  }
  if (o.mels < 1 || o.mels > 4096) {
    return bad("mels is " + std::to_string(o.mels) + ", expected 1 to 4096");
  }
  const double f_max = o.f_max == 0 ? o.sample_rate / 2.0 : o.f_max;
  if (!(o.f_min >= 0 && o.f_min < f_max && f_max <= o.sample_rate / 2.0)) {
    return bad("f_min and f_max, expected 0 <= f_min < f_max <= half of sample_rate, " +
               std::to_string(o.sample_rate) + " Hz");
  }
  if (!(o.floor > 0)) return bad("floor, expected more than 0");
  return Status();
}

// Where index i of an endless reflection of n samples lies in them.
std::size_t Mirror(std::ptrdiff_t i, std::size_t n) {
  if (n == 1) return 0;
  const auto period = static_cast<std::ptrdiff_t>(2 * (n - 1));
  const std::ptrdiff_t at = (i % period + period) % period;
  return static_cast<std::size_t>(std::min(at, period - at));
}

std::size_t Size(int n) { return static_cast<std::size_t>(n); }

}  // namespace

LogMelOptions PatsLogMel512(int sample_rate) { return {.sample_rate = sample_rate}; }

LogMelOptions PatsLogMel400() {
  return {.sample_rate = 16000,
          .fft_size = 512,
          .window_size = 400,
          .hop = 160,
          .center = false,
          .power = false,
          .mels = 64,
          .f_min = 125,
          .f_max = 7500,
          .slaney_norm = false,
          .floor = 1e-6};
}

Result<LogMel> LogMel::Make(const LogMelOptions& options) {
  GESTUS_RETURN_IF_ERROR(Check(options));
  const double rate = options.sample_rate;
  return LogMel(options, MelBank::Slaney({.sample_rate = rate,
                                          .fft_size = Size(options.fft_size),
                                          .filters = Size(options.mels),
                                          .f_min = options.f_min,
                                          .f_max = options.f_max == 0 ? rate / 2 : options.f_max},
                                         options.slaney_norm));
}

LogMel::LogMel(const LogMelOptions& options, MelBank bank)
    : options_(options),
      bank_(std::move(bank)),
      fft_(Size(options.fft_size)),
      framer_(Size(options.fft_size), Size(options.hop)),
      window_(Size(options.fft_size)),
      frame_(Size(options.fft_size)),
      power_(fft_.bins()),
      sums_(bank_.filters()) {
  const std::size_t before = Size((options.fft_size - options.window_size) / 2);
  for (std::size_t i = 0; i < Size(options.window_size); ++i) {
    window_[before + i] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / options.window_size);
  }
  if (options.center) {
    mirrored_.resize(Size(options.fft_size / 2));
    head_.resize(mirrored_.size() + 1);
  }
}

void LogMel::WriteRow(const float* frame, float* row) {
  for (std::size_t i = 0; i < frame_.size(); ++i) {
    frame_[i] = window_[i] * static_cast<double>(frame[i]);
  }
  fft_.Power(frame_.data(), power_.data());
  if (!options_.power) {
    for (double& p : power_) p = std::sqrt(p);
  }
  bank_.Apply(power_.data(), sums_.data());
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    // librosa's sums are float32: what underflows there counts as zero.
    const double sum = static_cast<float>(sums_[k]);
    row[k] = static_cast<float>(std::log(sum == 0 ? options_.floor : sum));
  }
}

float* LogMel::Append(const float* samples, std::size_t n, float* rows) {
  framer_.Push(samples, n, [&](const float* frame) {
    WriteRow(frame, rows);
    rows += options_.mels;
  });
  return rows;
}

std::size_t LogMel::MaxRows(std::size_t samples) const {
  return samples == 0 ? 0 : 1 + samples / Size(options_.hop);
}

std::size_t LogMel::Push(const float* samples, std::size_t n, float* rows) {
  float* end = rows;
  if (head_size_ < head_.size()) {
    const std::size_t take = std::min(n, head_.size() - head_size_);
    std::copy_n(samples, take, head_.data() + head_size_);
    head_size_ += take;
    samples += take;
    n -= take;
    if (head_size_ < head_.size()) return 0;
    std::reverse_copy(head_.begin() + 1, head_.end(), mirrored_.begin());
    end = Append(mirrored_.data(), mirrored_.size(), end);
    end = Append(head_.data(), head_.size(), end);
  }
  end = Append(samples, n, end);
  return static_cast<std::size_t>(end - rows) / Size(options_.mels);
}

std::size_t LogMel::MaxRowsAtFinish() const {
  return options_.center ? 1 + mirrored_.size() / Size(options_.hop) : 0;
}

// All rows of a recording that ended before it filled head_.
float* LogMel::AppendShort(float* rows) {
  const auto n = static_cast<std::ptrdiff_t>(head_size_);
  const auto pad = static_cast<std::ptrdiff_t>(mirrored_.size());
  for (std::ptrdiff_t i = -pad; n > 0 && i < n + pad; ++i) {
    rows = Append(&head_[Mirror(i, head_size_)], 1, rows);
  }
  return rows;
}

std::size_t LogMel::Finish(float* rows) {
  float* end = rows;
  if (head_size_ < head_.size()) {
    end = AppendShort(rows);
  } else if (options_.center) {
    const float* last = framer_.end() - 1;
    std::reverse_copy(last - mirrored_.size(), last, mirrored_.begin());
    end = Append(mirrored_.data(), mirrored_.size(), end);
  }
  framer_.Clear();
  head_size_ = 0;
  return static_cast<std::size_t>(end - rows) / Size(options_.mels);
}

}  // namespace gestus::audio
