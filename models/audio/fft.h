// Power and magnitude spectra of real frames.  A private header of the front ends.
#ifndef GESTUS_MODELS_AUDIO_FFT_H_
#define GESTUS_MODELS_AUDIO_FFT_H_

#include <cstddef>
#include <memory>

namespace gestus::audio {

/// The discrete Fourier transform of real frames of one even size >= 2.  T is float or double.
/// Everything is allocated by the constructor.
template <class T>
class RealFft {
 public:
  explicit RealFft(std::size_t size);
  ~RealFft();
  RealFft(RealFft&&) noexcept;
  RealFft& operator=(RealFft&&) noexcept;

  std::size_t size() const;
  std::size_t bins() const { return size() / 2 + 1; }  ///< from 0 to half the sample rate

  /// |X|^2 of `frame` (size) into `power` (bins).
  void Power(const T* frame, T* power);

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_FFT_H_
