// Section 4.1.6 of the thesis: a median filter against noise, and straight lines over the frames
// in which nothing was found.
//
//   Result<CleanReport> report = Clean(&clip.track);                              // OpenFace
//   Result<CleanReport> report = Clean(&clip.body, {.order = CleanOrder::kFillFirst});  // OpenPose
#ifndef GESTUS_MODELS_MOTION_CLEAN_H_
#define GESTUS_MODELS_MOTION_CLEAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/motion/clip.h"

namespace gestus::motion {

enum class CleanOrder {
  /// The thesis': the median of what stands in the file, lost frames too and zeros beyond both ends
  /// (scipy.signal.medfilt), then lines over the lost frames.
  kMedianFirst,
  /// For key points, where a lost one stands as 0: lines first, then the median of the whole, with
  /// the first and the last value repeated beyond the ends.
  kFillFirst,
};

struct CleanOptions {
  int median = 7;  ///< frames, odd, to 99; 1 leaves values as they are
  CleanOrder order = CleanOrder::kMedianFirst;
  float min_confidence = 0;  ///< a point counts as seen above this
};

struct CleanReport {
  std::int64_t lost_frames = 0;         ///< in which no point was seen
  std::int64_t filled_points = 0;       ///< points of frames, over all points that were seen at all
  std::int64_t longest_gap = 0;         ///< frames in a row that one point was filled in
  std::vector<std::string> never_seen;  ///< points
  std::vector<std::string> notes;       ///< the same in words
};

/// Cleans every column of `track` by itself, in place.  Before the first and after the last frame
/// in which it was seen a point stays where it is seen next.  Confidence becomes 0 where a value
/// was filled in; a point that was never seen keeps its values, without confidence in any frame.
///
/// Errors: a median that is not odd or too long, a confidence outside of 0 to 1; no point was seen
/// in any frame.
Result<CleanReport> Clean(Track* track, const CleanOptions& options = {});

/// The median of `size` (odd) values around each of `n`; beyond the ends stand zeros or, with
/// `hold_ends`, the first and the last value.
void MedianFilter(const float* x, std::int64_t n, int size, bool hold_ends, float* y);

/// Replaces the values of `x` that were not `seen` (as many) by straight lines between those that
/// were, beyond the first and the last of them by the nearest.  Without any `x` stays as it is.
void FillGaps(const std::vector<std::uint8_t>& seen, std::vector<float>* x);

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_CLEAN_H_
