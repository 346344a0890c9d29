// Inner products in an order that vector units can keep.  A private header.
#ifndef GESTUS_MODELS_PROSODY_DOT_H_
#define GESTUS_MODELS_PROSODY_DOT_H_

#include <cstddef>

namespace gestus::prosody {

/// sum a[i] b[i], i < n, in four interleaved sums.
inline double Dot(const double* a, const double* b, std::size_t n) {
  double sums[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (std::size_t l = 0; l < 4; ++l) sums[l] += a[i + l] * b[i + l];
  for (; i < n; ++i) sums[0] += a[i] * b[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_DOT_H_
