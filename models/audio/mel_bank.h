// Triangular filters on a mel scale, in the two forms the networks were trained with.  A private
// header of the front ends.
#ifndef GESTUS_MODELS_AUDIO_MEL_BANK_H_
#define GESTUS_MODELS_AUDIO_MEL_BANK_H_

#include <cstddef>
#include <vector>

namespace gestus::audio {

struct MelBankOptions {
  double sample_rate = 0;
  std::size_t fft_size = 0;
  std::size_t filters = 0;
  double f_min = 0, f_max = 0;  ///< Hz
};

class MelBank {
 public:
  /// librosa's default: straight lines in Hz between corners that are equally far apart in mel, the
  /// mel of Slaney's Auditory Toolbox.  `area`: each filter scaled to 2 / (its width in Hz).
  static MelBank Slaney(const MelBankOptions& options, bool area);
  /// Kaldi's: straight lines in mel, 1127 ln(1 + f / 700); the bin of half the sample rate is left
  /// out.
  static MelBank Kaldi(const MelBankOptions& options);

  std::size_t filters() const { return filters_.size(); }

  /// sums (filters) of `power` (bins).
  void Apply(const double* power, double* sums) const;

 private:
  struct Filter {
    std::size_t first_bin, first_weight, size;
  };

  template <class Weight>
  void AddFilter(std::size_t bins, const Weight& weight_of_bin);

  std::vector<Filter> filters_;
  std::vector<double> weights_;
};

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_MEL_BANK_H_
