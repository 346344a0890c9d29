// One column of motion, a coordinate or an action unit over time, and what finishing does to it.
#ifndef GESTUS_MODELS_OUTPUTS_COLUMNS_H_
#define GESTUS_MODELS_OUTPUTS_COLUMNS_H_

#include <cstdint>
#include <vector>

#include "models/outputs/finish.h"

namespace gestus::outputs {

using Column = std::vector<double>;

/// `x`, whose frames are `from` a second, at the times i / to, i < frames; its end is held.
Column Interpolate(const Column& x, double from, double to, std::int64_t frames, Interpolation how);

/// The parabola that fits best to the 2 * half + 1 values around each, which `x` must have.
Column FitParabolas(const Column& x, std::int64_t half);

/// A place where the motion began anew.
struct Seam {
  std::int64_t at = 0;      ///< the first frame after
  std::int64_t before = 1;  ///< frames to the seam before, or to the beginning
  std::int64_t after = 1;   ///< frames to the next seam, or to the end
};
/// Adds to `x` what takes the jump of `original` (as many values) out of `seam`, over so many
/// `frames` to either side.
void FadeSeam(const Column& original, const Seam& seam, double frames, Column* x);

/// The middle value, or the mean of the two in the middle.
double Median(Column x);

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_COLUMNS_H_
