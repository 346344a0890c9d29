#include "models/audio/fft.h"

#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace gestus::audio {

template <class T>
struct RealFft<T>::Plan {
  Eigen::FFT<T> fft;
  std::vector<std::complex<T>> spectrum;
  std::size_t size;
};

template <class T>
RealFft<T>::RealFft(std::size_t size) : plan_(std::make_unique<Plan>()) {
  plan_->size = size;
  plan_->spectrum.resize(size);
  plan_->fft.SetFlag(Eigen::FFT<T>::HalfSpectrum);
  // The library makes its tables when it first meets a size.
  const std::vector<T> silence(size);
  std::vector<T> power(bins());
  Power(silence.data(), power.data());
}

template <class T>
RealFft<T>::~RealFft() = default;
template <class T>
RealFft<T>::RealFft(RealFft&&) noexcept = default;
template <class T>
RealFft<T>& RealFft<T>::operator=(RealFft&&) noexcept = default;

template <class T>
std::size_t RealFft<T>::size() const {
  return plan_->size;
}

template <class T>
void RealFft<T>::Power(const T* frame, T* power) {
  plan_->fft.fwd(plan_->spectrum.data(), frame, static_cast<Eigen::Index>(plan_->size));
  for (std::size_t i = 0; i < bins(); ++i) power[i] = std::norm(plan_->spectrum[i]);
}

template class RealFft<float>;
template class RealFft<double>;

}  // namespace gestus::audio
