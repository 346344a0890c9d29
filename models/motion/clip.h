// A recorded movement in memory: points of a figure, or columns of numbers, over time.
#ifndef GESTUS_MODELS_MOTION_CLIP_H_
#define GESTUS_MODELS_MOTION_CLIP_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"

namespace gestus::motion {

/// Key points have two coordinates, x and y in pixels with y down; a column of OpenFace is a point
/// with one.  Columns lie as in PATS: x of every point, then y of every point.
struct Track {
  Track() = default;
  /// All values and confidences 0.
  Track(std::vector<std::string> names, std::int64_t coordinates_of_a_point, std::int64_t n,
        double rate);

  std::vector<std::string> points;  ///< their names
  std::int64_t coordinates = 0;     ///< of a point
  std::int64_t frames = 0;
  double frame_rate = 0;          ///< frames per second
  std::vector<float> values;      ///< (frames, coordinates * points)
  std::vector<float> confidence;  ///< (frames, points): 0 not seen, to 1

  std::int64_t point_count() const { return static_cast<std::int64_t>(points.size()); }
  std::int64_t columns() const { return coordinates * point_count(); }
  float& value(std::int64_t frame, std::int64_t coordinate, std::int64_t point) {
    return values[Index(frame, coordinate, point)];
  }
  float value(std::int64_t frame, std::int64_t coordinate, std::int64_t point) const {
    return values[Index(frame, coordinate, point)];
  }
  float& seen(std::int64_t frame, std::int64_t point) {
    return confidence[static_cast<std::size_t>(frame * point_count() + point)];
  }
  float seen(std::int64_t frame, std::int64_t point) const {
    return confidence[static_cast<std::size_t>(frame * point_count() + point)];
  }
  /// Whether any frame has the point.
  bool Has(std::int64_t point) const;

 private:
  std::size_t Index(std::int64_t frame, std::int64_t coordinate, std::int64_t point) const {
    return static_cast<std::size_t>(frame * columns() + coordinate * point_count() + point);
  }
};

/// Longest clip that a reader takes unless told otherwise: 9.7 hours at 30 frames per second.
constexpr std::int64_t kMaxFrames = 1 << 20;

/// Frames from number `first` to number `last` when `present` of them are there.  An error when
/// they are more than `max_frames`, or so many more than those present that a wrong number, not a
/// gap, must be the reason.
Result<std::int64_t> CountFrames(std::int64_t first, std::int64_t last, std::int64_t present,
                                 std::int64_t max_frames);

/// An error unless `rate` is from 1 to 1000 frames per second; `what` names it.
Status CheckFrameRate(double rate, const std::string& what);

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_CLIP_H_
