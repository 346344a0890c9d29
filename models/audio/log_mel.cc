#include "models/audio/log_mel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "models/audio/fft.h"
#include "models/audio/framer.h"
#include "models/audio/mel_bank.h"
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

struct LogMel::State {
  State(const LogMelOptions& with, MelBank mels);
  std::size_t Width() const { return sums.size(); }
  /// Each adds samples and returns where the next row goes.
  float* Append(const float* samples, std::size_t n, float* rows);
  float* AppendShort(float* rows);
  void WriteRow(const float* from, float* row);

  LogMelOptions options;
  MelBank bank;
  RealFft<double> fft;
  Framer framer;
  std::vector<double> window, frame, power, sums;
  std::vector<float> head;  // a centred recording's first samples, until they can be mirrored
  std::size_t head_size = 0;
  std::vector<float> mirrored;
};

LogMel::State::State(const LogMelOptions& with, MelBank mels)
    : options(with),
      bank(std::move(mels)),
      fft(Size(with.fft_size)),
      framer(Size(with.fft_size), Size(with.hop)),
      window(Size(with.fft_size)),
      frame(Size(with.fft_size)),
      power(fft.bins()),
      sums(bank.filters()) {
  const std::size_t before = Size((options.fft_size - options.window_size) / 2);
  for (std::size_t i = 0; i < Size(options.window_size); ++i) {
    window[before + i] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / options.window_size);
  }
  if (options.center) {
    mirrored.resize(Size(options.fft_size / 2));
    head.resize(mirrored.size() + 1);
  }
}

void LogMel::State::WriteRow(const float* from, float* row) {
  for (std::size_t i = 0; i < frame.size(); ++i) {
    frame[i] = window[i] * static_cast<double>(from[i]);
  }
  fft.Power(frame.data(), power.data());
  if (!options.power) {
    for (double& p : power) p = std::sqrt(p);
  }
  bank.Apply(power.data(), sums.data());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    // librosa's sums are float32: what underflows there counts as zero.
    const double sum = static_cast<float>(sums[k]);
    row[k] = static_cast<float>(std::log(sum == 0 ? options.floor : sum));
  }
}

float* LogMel::State::Append(const float* samples, std::size_t n, float* rows) {
  framer.Push(samples, n, [&](const float* from) {
    WriteRow(from, rows);
    rows += Width();
  });
  return rows;
}

// All rows of a recording that ended before it filled the head.
float* LogMel::State::AppendShort(float* rows) {
  const auto n = static_cast<std::ptrdiff_t>(head_size);
  const auto pad = static_cast<std::ptrdiff_t>(mirrored.size());
  for (std::ptrdiff_t i = -pad; n > 0 && i < n + pad; ++i) {
    rows = Append(&head[Mirror(i, head_size)], 1, rows);
  }
  return rows;
}

Result<LogMel> LogMel::Make(const LogMelOptions& options) {
  GESTUS_RETURN_IF_ERROR(Check(options));
  const double rate = options.sample_rate;
  return LogMel(std::make_unique<State>(
      options, MelBank::Slaney({.sample_rate = rate,
                                .fft_size = Size(options.fft_size),
                                .filters = Size(options.mels),
                                .f_min = options.f_min,
                                .f_max = options.f_max == 0 ? rate / 2 : options.f_max},
                               options.slaney_norm)));
}

LogMel::LogMel(std::unique_ptr<State> state) : state_(std::move(state)) {}
LogMel::~LogMel() = default;
LogMel::LogMel(LogMel&&) noexcept = default;
LogMel& LogMel::operator=(LogMel&&) noexcept = default;

int LogMel::width() const { return state_->options.mels; }

std::size_t LogMel::MaxRows(std::size_t samples) const {
  return samples == 0 ? 0 : 1 + samples / Size(state_->options.hop);
}

std::size_t LogMel::Push(const float* samples, std::size_t n, float* rows) {
  State& s = *state_;
  float* end = rows;
  if (s.head_size < s.head.size()) {
    const std::size_t take = std::min(n, s.head.size() - s.head_size);
    std::copy_n(samples, take, s.head.data() + s.head_size);
    s.head_size += take;
    samples += take;
    n -= take;
    if (s.head_size < s.head.size()) return 0;
    std::reverse_copy(s.head.begin() + 1, s.head.end(), s.mirrored.begin());
    end = s.Append(s.mirrored.data(), s.mirrored.size(), end);
    end = s.Append(s.head.data(), s.head.size(), end);
  }
  end = s.Append(samples, n, end);
  return static_cast<std::size_t>(end - rows) / s.Width();
}

std::size_t LogMel::MaxRowsAtFinish() const {
  return state_->options.center ? 1 + state_->mirrored.size() / Size(state_->options.hop) : 0;
}

std::size_t LogMel::Finish(float* rows) {
  State& s = *state_;
  float* end = rows;
  if (s.head_size < s.head.size()) {
    end = s.AppendShort(rows);
  } else if (s.options.center) {
    const float* last = s.framer.end() - 1;
    std::reverse_copy(last - s.mirrored.size(), last, s.mirrored.begin());
    end = s.Append(s.mirrored.data(), s.mirrored.size(), end);
  }
  s.framer.Clear();
  s.head_size = 0;
  return static_cast<std::size_t>(end - rows) / s.Width();
}

}  // namespace gestus::audio
