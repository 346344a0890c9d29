#include "models/motion/resample.h"

#include <algorithm>
#include <cmath>

namespace gestus::motion {

Result<Track> Resample(const Track& track, double rate) {
  GESTUS_RETURN_IF_ERROR(CheckFrameRate(rate, "the frame rate to resample to"));
  GESTUS_RETURN_IF_ERROR(CheckFrameRate(track.frame_rate, "the frame rate of the clip"));
  if (track.frames < 1) {
    return Status(Code::kBadInput, "a clip without frames, expected one at least");
  }
  const double step = track.frame_rate / rate;
  // 25 frames of 25 per second are 15 of 15, whatever the division rounds to.
  const double count = std::floor(static_cast<double>(track.frames) / step + 1e-6);
  Track out(track.points, track.coordinates, std::max<std::int64_t>(1, std::llround(count)), rate);
  const std::int64_t columns = track.columns(), points = track.point_count();
  for (std::int64_t i = 0; i < out.frames; ++i) {
    const double at = static_cast<double>(i) * track.frame_rate / rate;
    const std::int64_t left = std::min(static_cast<std::int64_t>(at), track.frames - 1);
    const double part = at - static_cast<double>(left);
    const std::int64_t right = part > 0 ? std::min(left + 1, track.frames - 1) : left;
    const float* a = track.values.data() + left * columns;
    const float* b = track.values.data() + right * columns;
    float* to = out.values.data() + i * columns;
    for (std::int64_t c = 0; c < columns; ++c) {
      to[c] = static_cast<float>(a[c] + (static_cast<double>(b[c]) - a[c]) * part);
    }
    for (std::int64_t p = 0; p < points; ++p) {
      out.seen(i, p) = std::min(track.seen(left, p), track.seen(right, p));
    }
  }
  return out;
}

}  // namespace gestus::motion
