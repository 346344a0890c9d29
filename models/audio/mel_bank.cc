#include "models/audio/mel_bank.h"

#include <algorithm>
#include <cmath>

namespace gestus::audio {
namespace {

// Slaney's scale: 66.7 Hz to a mel up to 1 kHz, from there 27 mels to each factor of 6.4.
constexpr double kLinearHz = 200.0 / 3.0;
constexpr double kCornerHz = 1000.0;
constexpr double kCornerMel = kCornerHz / kLinearHz;
const double kLogStep = std::log(6.4) / 27.0;

double SlaneyMel(double hz) {
  return hz < kCornerHz ? hz / kLinearHz : kCornerMel + std::log(hz / kCornerHz) / kLogStep;
}

double SlaneyHz(double mel) {
  return mel < kCornerMel ? mel * kLinearHz : kCornerHz * std::exp(kLogStep * (mel - kCornerMel));
}

template <class T>
T KaldiMel(T hz) {
  return T{1127} * std::log(T{1} + hz / T{700});
}

// Filter k rises from corner k to corner k + 1 and falls to corner k + 2.
template <class T>
T Triangle(T at, const T* corner) {
  const T up = (at - corner[0]) / (corner[1] - corner[0]);
  const T down = (corner[2] - at) / (corner[2] - corner[1]);
  return std::max(T{0}, std::min(up, down));
}

// Corners equally far apart on the scale, those of the first and the last filter at its ends.
template <class T>
std::vector<T> Corners(double low, double high, std::size_t filters) {
  std::vector<T> corners(filters + 2);
  const T first = static_cast<T>(low);
  const T step = static_cast<T>((high - low) / static_cast<double>(filters + 1));
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = first + static_cast<T>(i) * step;
  return corners;
}

}  // namespace

// Keeps the bins from the first to the last weight that is not zero; a filter that falls between
// two bins has none.
template <class Weight>
void MelBank::AddFilter(std::size_t bins, const Weight& weight_of_bin) {
  Filter filter = {0, weights_.size(), 0};
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const double weight = weight_of_bin(bin);
    if (weight == 0) continue;
    if (filter.size == 0) filter.first_bin = bin;
    filter.size = bin - filter.first_bin + 1;
    weights_.resize(filter.first_weight + filter.size);
    weights_.back() = weight;
  }
  filters_.push_back(filter);
}

MelBank MelBank::Slaney(const MelBankOptions& o, bool area) {
  std::vector<double> corners = Corners<double>(SlaneyMel(o.f_min), SlaneyMel(o.f_max), o.filters);
  for (double& corner : corners) corner = SlaneyHz(corner);
  const double bin_hz = o.sample_rate / static_cast<double>(o.fft_size);
  MelBank bank;
  for (std::size_t k = 0; k < o.filters; ++k) {
    const double scale = area ? 2.0 / (corners[k + 2] - corners[k]) : 1.0;
    bank.AddFilter(o.fft_size / 2 + 1, [&](std::size_t bin) {
      return scale * Triangle(static_cast<double>(bin) * bin_hz, &corners[k]);
    });
  }
  return bank;
}

// In float32, as Kaldi and torchaudio: the lowest filters are narrower than a bin, and one that a
// bin only touches has a weight of few digits, which the logarithm shows.
MelBank MelBank::Kaldi(const MelBankOptions& o) {
  const auto corners = Corners<float>(KaldiMel(o.f_min), KaldiMel(o.f_max), o.filters);
  const auto bin_hz = static_cast<float>(o.sample_rate / static_cast<double>(o.fft_size));
  MelBank bank;
  for (std::size_t k = 0; k < o.filters; ++k) {
    bank.AddFilter(o.fft_size / 2, [&](std::size_t bin) {
      return static_cast<double>(Triangle(KaldiMel(bin_hz * static_cast<float>(bin)), &corners[k]));
    });
  }
  return bank;
}

void MelBank::Apply(const double* power, double* sums) const {
  for (std::size_t k = 0; k < filters_.size(); ++k) {
    const Filter& filter = filters_[k];
    const double* p = power + filter.first_bin;
    const double* w = weights_.data() + filter.first_weight;
    // Two sums, since a processor adds faster than it can wait for each addition.
    double even = 0, odd = 0;
    std::size_t i = 0;
    for (; i + 1 < filter.size; i += 2) {
      even += w[i] * p[i];
      odd += w[i + 1] * p[i + 1];
    }
    if (i < filter.size) even += w[i] * p[i];
    sums[k] = even + odd;
  }
}

}  // namespace gestus::audio
