#include "models/outputs/columns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gestus::outputs {
namespace {

/// Velocities at the frames of `x`, per frame: the harmonic mean of the slopes on both sides, 0
/// where they point in different directions (Fritsch and Butland 1984).
Column MonotoneVelocities(const Column& x) {
  const std::size_t n = x.size();
  Column slope(n - 1), v(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) slope[i] = x[i + 1] - x[i];
  if (n == 2) return {slope[0], slope[0]};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = slope[i - 1], b = slope[i];
    if ((a > 0 && b > 0) || (a < 0 && b < 0)) v[i] = 2 / (1 / a + 1 / b);
  }
  // At an end: of the parabola through three frames, as far as that does not overshoot.
  const auto end = [](double near, double far) {
    const double velocity = (3 * near - far) / 2;
    if (velocity * near <= 0) return 0.0;
    return near * far < 0 && std::fabs(velocity) > 3 * std::fabs(near) ? 3 * near : velocity;
  };
  v[0] = end(slope[0], slope[1]);
  v[n - 1] = end(slope[n - 2], slope[n - 3]);
  return v;
}

}  // namespace

Column Interpolate(const Column& x, double from, double to, std::int64_t frames,
                   Interpolation how) {
  Column out(static_cast<std::size_t>(frames));
  const bool cubic = how == Interpolation::kMonotone && x.size() > 1;
  const Column v = cubic ? MonotoneVelocities(x) : Column();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double at = static_cast<double>(i) * from / to;  // exact where a frame of x is meant
    const std::size_t left = std::min(static_cast<std::size_t>(at), x.size() - 1);
    const std::size_t right = std::min(left + 1, x.size() - 1);
    const double t = at - static_cast<double>(left), jump = x[right] - x[left];
    if (t <= 0 || right == left) {
      out[i] = x[left];
    } else if (!cubic) {
      out[i] = x[left] + t * jump;
    } else {
      // Hermite's cubic in the form of Horner.
      const double b = 3 * jump - 2 * v[left] - v[right], c = v[left] + v[right] - 2 * jump;
      out[i] = x[left] + t * (v[left] + t * (b + t * c));
    }
  }
  return out;
}

Column FitParabolas(const Column& x, std::int64_t half) {
  const auto n = static_cast<std::int64_t>(x.size()), window = 2 * half + 1;
  double s2 = 0, s4 = 0;
  for (std::int64_t i = -half; i <= half; ++i) {
    const auto square = static_cast<double>(i * i);
    s2 += square;
    s4 += square * square;
  }
  const double s0 = static_cast<double>(window), determinant = s0 * s4 - s2 * s2;
  Column out(x.size());
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t centre = std::clamp(i, half, n - 1 - half);
    double sum0 = 0, sum1 = 0, sum2 = 0;
    for (std::int64_t k = -half; k <= half; ++k) {
      const double value = x[static_cast<std::size_t>(centre + k)],
                   position = static_cast<double>(k);
      sum0 += value;
      sum1 += position * value;
      sum2 += position * position * value;
    }
    const double at = static_cast<double>(i - centre);
    const double constant = (s4 * sum0 - s2 * sum2) / determinant;
    const double square = (s0 * sum2 - s2 * sum0) / determinant;
    out[static_cast<std::size_t>(i)] = constant + at * (sum1 / s2 + at * square);
  }
  return out;
}

void FadeSeam(const Column& original, const Seam& seam, double frames, Column* x) {
  const auto at = static_cast<std::size_t>(seam.at);
  double velocity_before = seam.before > 1 ? original[at - 1] - original[at - 2] : 0;
  const double velocity_after =
      seam.after > 1 ? original[at + 1] - original[at] : velocity_before;  // one frame tells none
  if (seam.before == 1) velocity_before = velocity_after;
  // Both sides half a frame further, where they meet.
  const double jump =
      (original[at] - velocity_after / 2) - (original[at - 1] + velocity_before / 2);
  const double turn = velocity_after - velocity_before;
  // At distance u * width from the meeting point: half of the jump and of the turn at u = 0,
  // nothing at u = 1, as Hermite's cubics.
  const auto change = [&](double u, double width, double side) {
    const double left = (1 - u) * (1 - u);
    return side * jump / 2 * left * (1 + 2 * u) + turn / 2 * -u * width * left;
  };
  const double before = std::min(frames, static_cast<double>(seam.before));
  for (std::int64_t i = 0; static_cast<double>(i) + 0.5 < before; ++i)
    (*x)[at - 1 - static_cast<std::size_t>(i)] +=
        change((static_cast<double>(i) + 0.5) / before, before, 1);
  const double after = std::min(frames, static_cast<double>(seam.after));
  for (std::int64_t i = 0; static_cast<double>(i) + 0.5 < after; ++i)
    (*x)[at + static_cast<std::size_t>(i)] +=
        change((static_cast<double>(i) + 0.5) / after, after, -1);
}

double Median(Column x) {
  const std::size_t middle = x.size() / 2;
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(middle), x.end());
  const double upper = x[middle];
  if (x.size() % 2 == 1) return upper;
  return (*std::max_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(middle)) + upper) /
         2;
}

}  // namespace gestus::outputs
