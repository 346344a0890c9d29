// The last steps before motion is shown or played: other frame rates, no jumps where the network
// began anew, smoothing, amplitude, ranges.  Every step makes new motion of old.
//
//   Result<Finished> done = Finish(motion, {.frame_rate = 60, .amplitude = 0.8});
#ifndef GESTUS_MODELS_OUTPUTS_FINISH_H_
#define GESTUS_MODELS_OUTPUTS_FINISH_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/outputs/motion.h"

namespace gestus::outputs {

enum class Interpolation {
  /// Cubic and without overshoot (Fritsch and Butland 1984): between two frames a value stays
  /// between theirs, velocity has no jumps.
  kMonotone,
  kLinear,
};

struct FinishOptions {
  double frame_rate = 0;  ///< frames per second, 1 to 1000; 0: that of the motion
  Interpolation interpolation = Interpolation::kMonotone;
  double crossfade = 0.3;  ///< seconds on each side of a seam, 0 to 10; 0: seams stay as they are
  double smooth = 0;       ///< seconds that a smoothed value looks at, 0 to 10; 0: not at all
  double amplitude = 1;    ///< 0: still, 1: as it is, to 10
};

/// Bounds of the numbers in FinishOptions.
constexpr double kMaxFinishRate = 1000, kMaxFinishSeconds = 10, kMaxAmplitude = 10;

/// Mean length of the third derivative of one part of the motion.
struct Jerk {
  std::string part;  ///< "body", "face", "action units", "angles"
  std::string unit;  ///< "shoulder lengths/s^3"
  double value = 0;
};

struct Finished {
  Motion motion;
  /// Both at the frame rate before, for jerk of more frames a second sees more of the same motion.
  std::vector<Jerk> before, after;
  std::vector<std::string> notes;
};

/// CrossFade, Amplify, Resample and Smooth (the other way round when frames become fewer), Clamp.
/// Errors: an option that is not within its bounds; more than 2^28 values in one part.
Result<Finished> Finish(const Motion& motion, const FinishOptions& options);

/// `motion` at `rate` frames per second, a positive number: frame i is the motion at i / rate
/// seconds, the last frame is held.  There are floor(frames * rate / motion.frame_rate) frames, at
/// least one.
Motion Resample(const Motion& motion, double rate,
                Interpolation interpolation = Interpolation::kMonotone);

/// Takes the jumps out of seams.  The motion of both sides is drawn on, in a straight line, to the
/// time halfway between the last frame before and the first after; there both get the mean of the
/// two values and velocities.  The difference fades, by a cubic, over `seconds` to either side but
/// never beyond the next seam; frames further away keep every bit.  Where a side is one frame its
/// velocity is the other's.
Motion CrossFade(const Motion& motion, double seconds);

/// Savitzky-Golay: each value becomes that of the parabola that fits best to the values at most
/// seconds / 2 away, without delay.  Near the ends it is the parabola of the first and the last
/// such stretch.  Where that is less than five frames nothing changes.
Motion Smooth(const Motion& motion, double seconds);

/// Values at `amplitude` times their distance from the rest pose, the median of each column over
/// the whole motion; the position of the neck in the picture stays.
Motion Amplify(const Motion& motion, double amplitude);

/// Action units ("AU...") within their range, where one is given.
Motion Clamp(const Motion& motion);

/// Lengths of third differences times the cube of the frame rate, the mean over frames and points
/// but the neck, the origin; action units and angles by themselves.  Nothing for motion of less
/// than four frames.
std::vector<Jerk> MeanJerk(const Motion& motion);

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_FINISH_H_
