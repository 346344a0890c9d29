// What a gesture network put out, as motion over time: the one form that finishing, players and
// file formats start from.
#ifndef GESTUS_MODELS_OUTPUTS_MOTION_H_
#define GESTUS_MODELS_OUTPUTS_MOTION_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/network.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::outputs {

struct Point {
  std::string name;          ///< "RWrist"
  std::int64_t parent = -1;  ///< index into the points; -1: a root
  std::int64_t source = 0;   ///< PATS' joint 0 to 51, or OpenPose's face point 0 to 69
};

/// Points in the plane, x to the right and y down as in a picture, relative to the neck.  The unit
/// is PATS': with Motion::normalised a shoulder (neck to right shoulder) is 167 long, else pixels.
struct Figure {
  std::vector<Point> points;
  std::vector<float> values;  ///< (frames, 2 * points): x of all, then y of all
  /// Whether the columns of the neck hold its position in the picture (PATS) or nothing.
  bool neck_is_position = true;

  std::int64_t columns() const { return 2 * static_cast<std::int64_t>(points.size()); }
  float x(std::int64_t frame, std::size_t point) const {
    return values[static_cast<std::size_t>(frame * columns()) + point];
  }
  float y(std::int64_t frame, std::size_t point) const {
    return values[static_cast<std::size_t>(frame * columns()) + points.size() + point];
  }
};

struct Curve {
  std::string name;  ///< "AU01", "Rx"
  std::string unit;  ///< "intensity 0 to 5", "rad"
  float minimum = 0, maximum = 0;
};

/// Action units and head angles over time.
struct Curves {
  std::vector<Curve> curves;
  std::vector<float> values;  ///< (frames, curves)
  float at(std::int64_t frame, std::size_t curve) const {
    return values[static_cast<std::size_t>(frame) * curves.size() + curve];
  }
};

/// Whatever is there has as many frames.
struct Motion {
  double frame_rate = 15;
  std::int64_t frames = 0;
  bool normalised = true;
  std::optional<Figure> body, face;
  std::optional<Curves> curves;
  /// Frames at which the network began anew, without having seen what came before: where jumps may
  /// be.
  std::vector<std::int64_t> seams;

  double seconds() const { return static_cast<double>(frames) / frame_rate; }
};

/// How the sequences of Model 1 and Model 2, one for each word or window, become one over time.
struct CurveOptions {
  double frame_rate = 24;  ///< of the videos that they were trained on (thesis 4.1.3)
};

/// What motion of the network `record` has: its points and curves, and no frame.  Errors: a network
/// that makes no motion.
Result<Motion> LayoutOf(const fb::Network& record);

/// The motion in `outputs` of the network `record`: "pose" and "face" of ZS-MSTM, or "face" and
/// "lengths" of Model 1 and Model 2 with "times_ms" beside them.
///
/// A sequence begins where its word or window begins and goes on at the options' rate until it ends
/// or the next one begins; in between, and before the first, lies the straight line from the last
/// value to the next (before the first: the first).  Without "times_ms" sequences follow one
/// another. Errors: a network that makes no motion; arrays that do not fit it.
Result<Motion> MotionOf(const fb::Network& record, const models::Arrays& outputs,
                        const CurveOptions& options = {});

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_MOTION_H_
