#include "models/audio/frames.h"

namespace gestus::audio {
namespace {

std::int64_t PatsRow(const PatsSegments& s, int frames_per_second, std::int64_t frame) {
  // Python's int() cuts off, and its round() goes to the even number, which no ratio in use asks
  // for.
  const auto window = static_cast<std::int64_t>(s.seconds * s.rows_per_second);
  const std::int64_t stride = (2 * s.rows_per_second + frames_per_second) / (2 * frames_per_second);
  return frame / s.frames * window + frame % s.frames * stride;
}

std::int64_t ExactRow(const RowTimes& t, std::int64_t frames_per_second, std::int64_t frame) {
  // (frame / frames_per_second * sample_rate - first_middle) / hop, rounded half up, in integers.
  const std::int64_t samples = frame * t.sample_rate - t.first_middle * frames_per_second;
  const std::int64_t unit = t.hop * frames_per_second;
  return samples <= 0 ? 0 : (2 * samples + unit) / (2 * unit);
}

}  // namespace

std::int64_t RowOfFrame(const RowPlan& plan, std::int64_t frame) {
  return plan.placement == RowPlacement::kPats
             ? PatsRow(plan.segments, plan.frames_per_second, frame)
             : ExactRow(plan.times, plan.frames_per_second, frame);
}

std::int64_t FramesWithin(const RowPlan& plan, std::int64_t rows) {
  // Rows rise with frames, so that the first frame beyond is found by halving.
  std::int64_t low = 0, high = 1;
  while (RowOfFrame(plan, high - 1) < rows) high *= 2;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (RowOfFrame(plan, middle) < rows) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace gestus::audio
