// Sinusoidal positions: computed once per model, so in double and without vectors.
#include <cmath>

#include "kernels/kernels.h"

namespace gestus::kernels {

void sinusoidal_positions(float* out, std::size_t length, std::size_t d) {
  for (std::size_t p = 0; p < length; ++p) {
    for (std::size_t i = 0; i < d; ++i) {
      const double exponent = static_cast<double>(i - i % 2) / static_cast<double>(d);
      const double angle = static_cast<double>(p) / std::pow(10000.0, exponent);
      *out++ = static_cast<float>(i % 2 == 0 ? std::sin(angle) : std::cos(angle));
    }
  }
}

}  // namespace gestus::kernels
