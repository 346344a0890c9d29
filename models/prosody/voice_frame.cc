#include "models/prosody/voice_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "models/prosody/dot.h"

namespace gestus::prosody {
namespace {

// A period may be this much longer or shorter than f0 says, and must resemble the one before.
constexpr double kPeriodRange = 0.2, kLeastResemblance = 0.5;
constexpr double kHarmonicsRange = 0.1;
constexpr double kMostDecibels = 100;

std::size_t FloorToSize(double x) { return static_cast<std::size_t>(std::floor(x)); }
double Decibels(double power_ratio) {
  return std::clamp(10 * std::log10(power_ratio), -kMostDecibels, kMostDecibels);
}

// The highest point of the parabola through three values one step apart, from the middle one.
Peak Vertex(double before, double at, double after) {
  const double bend = before - 2 * at + after, slope = (after - before) / 2;
  if (!(bend < 0)) return {0, at};
  const double place = std::clamp(-slope / bend, -1.0, 1.0);
  return {place, at + place * (slope + place * bend / 2)};
}

}  // namespace

PeakFinder::PeakFinder() {
  constexpr int kTaps = static_cast<int>(kReach);
  for (int step = -kFine; step <= kFine; ++step) {
    for (int tap = -kTaps; tap <= kTaps; ++tap) {
      const double u = std::numbers::pi * (tap - static_cast<double>(step) / kFine);
      const double sinc = tap * kFine == step ? 1 : std::sin(u) / u;
      weights_.push_back(sinc * (0.5 + 0.5 * std::cos(u / (kTaps + 2))));
    }
  }
}

Peak PeakFinder::Near(const double* y, std::size_t at, double sign) const {
  constexpr std::size_t kTaps = 2 * kReach + 1;
  double values[2 * kFine + 1];
  for (std::size_t step = 0; step < std::size(values); ++step)
    values[step] = sign * Dot(weights_.data() + step * kTaps, y + at - kReach, kTaps);
  const auto highest =
      static_cast<std::size_t>(std::max_element(values + 1, std::end(values) - 1) - values);
  const Peak fine = Vertex(values[highest - 1], values[highest], values[highest + 1]);
  const double steps = static_cast<double>(highest) - kFine + fine.place;
  return {static_cast<double>(at) + steps / kFine, fine.value};
}

// Half a period around a mark that lies a period too far, and what PeakFinder reads.
std::size_t VoiceFrame::ContextOf(double sample_rate, double min_hz) {
  return FloorToSize((0.5 + kPeriodRange) * sample_rate / min_hz) + PeakFinder::kReach + 4;
}

VoiceFrame::VoiceFrame(double sample_rate, std::size_t frame, double min_hz)
    : sample_rate_(sample_rate),
      min_hz_(min_hz * (1 - 1e-6)),  // of which f0 may be a rounding below
      frame_(frame),
      context_(ContextOf(sample_rate, min_hz)),
      fft_(std::bit_ceil(2 * frame)),
      x_(frame + 2 * context_),
      squares_(x_.size() + 1),
      hann_(frame),
      windowed_(fft_.size()),
      power_(fft_.bins()),
      correlations_(FloorToSize(2 * kPeriodRange * sample_rate / min_hz) + 2 * PeakFinder::kReach +
                    4) {
  for (std::size_t i = 0; i < frame; ++i)
    hann_[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                    static_cast<double>(frame));
  marks_.reserve(frame);
}

// False for silence and for what is not finite.
bool VoiceFrame::Load(const float* samples) {
  double mean = 0;
  for (std::size_t i = 0; i < frame_; ++i) mean += double{samples[context_ + i]};
  mean /= static_cast<double>(frame_);
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = double{samples[i]} - mean;
    squares_[i + 1] = squares_[i] + x_[i] * x_[i];
  }
  const double energy = squares_[context_ + frame_] - squares_[context_];
  // Rounding leaves something of a constant.
  return std::isfinite(squares_.back()) &&
         energy > 1e-20 * (1 + mean * mean) * static_cast<double>(frame_);
}

// Of n samples from a and from b on; 1 when one is the other, louder or softer.
double VoiceFrame::Correlation(std::size_t a, std::size_t b, std::size_t n) const {
  const double energy = (squares_[a + n] - squares_[a]) * (squares_[b + n] - squares_[b]);
  return energy > 0 ? Dot(x_.data() + a, x_.data() + b, n) / std::sqrt(energy) : 0;
}

// The lag from `low` to `high` at which n samples from `a` on resemble most those that lie so much
// later (direction 1) or earlier (-1), and how much they do.
Peak VoiceFrame::HighestCorrelation(std::size_t a, std::size_t n, int direction, double low,
                                    double high) {
  constexpr std::ptrdiff_t kReach = PeakFinder::kReach;
  const auto lowest = static_cast<std::ptrdiff_t>(low), highest = static_cast<std::ptrdiff_t>(high);
  const auto start = static_cast<std::ptrdiff_t>(a);
  auto out = correlations_.begin();
  for (std::ptrdiff_t lag = lowest - kReach; lag <= highest + kReach; ++lag)
    *out++ = Correlation(a, static_cast<std::size_t>(start + direction * lag), n);
  const auto at = std::max_element(correlations_.begin() + kReach, out - kReach);
  const auto place = at - correlations_.begin();
  const Peak peak = peaks_.Near(correlations_.data(), static_cast<std::size_t>(place));
  return {peak.place + static_cast<double>(lowest - kReach), peak.value};
}

// Adds marks from `start` on in one direction until the frame ends or the waveform changes.
void VoiceFrame::Step(double period, double start, int direction) {
  const auto half = FloorToSize(period / 2);
  const double begin = static_cast<double>(context_), end = begin + static_cast<double>(frame_);
  for (double mark = start;
       mark + direction * period >= begin && mark + direction * period < end;) {
    const Peak next = HighestCorrelation(FloorToSize(mark) - half, 2 * half, direction,
                                         (1 - kPeriodRange) * period, (1 + kPeriodRange) * period);
    mark += direction * next.place;
    if (next.value < kLeastResemblance || mark < begin || mark >= end) return;
    marks_.push_back(mark);
  }
}

// From the highest sample of the middle period outwards.
void VoiceFrame::FindMarks(double period) {
  const auto middle = x_.begin() + static_cast<std::ptrdiff_t>(context_ + frame_ / 2);
  const auto half = static_cast<std::ptrdiff_t>(period / 2);
  const auto louder = [](double a, double b) { return std::fabs(a) < std::fabs(b); };
  const auto highest = std::max_element(middle - half, middle + half, louder);
  const auto start = static_cast<double>(highest - x_.begin());
  marks_.clear();
  Step(period, start, -1);
  std::reverse(marks_.begin(), marks_.end());
  marks_.push_back(start);
  Step(period, start, 1);
}

// Peak to peak, in the period around a mark.
double VoiceFrame::Amplitude(double mark, double period) const {
  const auto from = x_.begin() + static_cast<std::ptrdiff_t>(mark - period / 2);
  const auto [low, high] = std::minmax_element(from, from + static_cast<std::ptrdiff_t>(period));
  const auto place = [this](auto at) { return static_cast<std::size_t>(at - x_.begin()); };
  return peaks_.Near(x_.data(), place(high)).value + peaks_.Near(x_.data(), place(low), -1).value;
}

double VoiceFrame::Harmonics(double period) {
  const double low = (1 - kHarmonicsRange) * period, high = (1 + kHarmonicsRange) * period;
  const std::size_t n = frame_ - FloorToSize(high);
  const double r = HighestCorrelation(context_, n, 1, low, high).value;
  return r >= 1 ? kMostDecibels : r <= 0 ? -kMostDecibels : Decibels(r / (1 - r));
}

// The highest power of the bins [begin, end), between them too.
double VoiceFrame::PeakLevel(std::size_t begin, std::size_t end) const {
  const auto first = power_.begin();
  const auto at =
      static_cast<std::size_t>(std::max_element(first + static_cast<std::ptrdiff_t>(begin),
                                                first + static_cast<std::ptrdiff_t>(end)) -
                               first);
  if (at == 0 || at + 1 >= power_.size() || !(power_[at - 1] > 0 && power_[at + 1] > 0))
    return power_[at];
  const Peak peak =
      Vertex(std::log(power_[at - 1]), std::log(power_[at]), std::log(power_[at + 1]));
  return std::exp(peak.value);
}

double VoiceFrame::Hammarberg() {
  for (std::size_t i = 0; i < frame_; ++i) windowed_[i] = hann_[i] * x_[context_ + i];
  fft_.Power(windowed_.data(), power_.data());
  const double bins_per_hz = static_cast<double>(fft_.size()) / sample_rate_;
  const std::size_t middle = FloorToSize(2000 * bins_per_hz) + 1;
  const std::size_t top = std::min(FloorToSize(5000 * bins_per_hz) + 1, power_.size());
  const double low = PeakLevel(0, middle), high = PeakLevel(middle, top);
  return high > 0 ? Decibels(low / high) : kMostDecibels;
}

FrameQuality VoiceFrame::Measure(const float* samples, double hz) {
  FrameQuality q;
  if (!Load(samples)) return q;
  q.hammarberg = Hammarberg();
  if (!(hz >= min_hz_)) return q;  // unvoiced
  const double period = sample_rate_ / hz;
  q.harmonics = Harmonics(period);
  FindMarks(period);
  const std::size_t periods = marks_.size() - 1;
  for (std::size_t i = 0; i < periods; ++i)
    q.shimmer +=
        std::fabs(20 * std::log10(Amplitude(marks_[i + 1], period) / Amplitude(marks_[i], period)));
  if (periods > 0) q.shimmer /= static_cast<double>(periods);
  for (std::size_t i = 2; i <= periods; ++i)
    q.jitter += std::fabs((marks_[i] - marks_[i - 1]) - (marks_[i - 1] - marks_[i - 2]));
  if (periods > 1) {
    const double mean = (marks_.back() - marks_.front()) / static_cast<double>(periods);
    q.jitter /= static_cast<double>(periods - 1) * mean;
  }
  return q;
}

}  // namespace gestus::prosody
