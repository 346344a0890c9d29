// Which row of speech features belongs to which frame of motion.
#ifndef GESTUS_MODELS_AUDIO_FRAMES_H_
#define GESTUS_MODELS_AUDIO_FRAMES_H_

#include <cstdint>

namespace gestus::audio {

enum class RowPlacement {
  /// As PATS' loader placed the rows that the networks were trained on: segment by segment, by a
  /// whole number of rows a second that is not the recording's (data/dataUtils.py of chahuja/pats).
  kPats,
  /// The row whose middle is nearest in time.
  kExact,
};

/// When rows are: row r has its middle at sample first_middle + r * hop.
struct RowTimes {
  std::int64_t sample_rate = 0;   ///< Hz
  std::int64_t hop = 512;         ///< samples
  std::int64_t first_middle = 0;  ///< 0 for log_mel_512; half a frame for rows that are not centred
};

/// PATS' segments.  Its loader takes int(seconds * rows_per_second) rows, then every n-th of them,
/// n being rows_per_second / frames_per_second rounded.
struct PatsSegments {
  int frames = 64;           ///< of motion in a segment
  double seconds = 4.3;      ///< of a segment; 1.07 with 16 frames
  int rows_per_second = 89;  ///< what the loader takes for log_mel_512; 103 for log_mel_400
};

struct RowPlan {
  RowPlacement placement = RowPlacement::kPats;
  RowTimes times = {};         ///< for kExact
  PatsSegments segments = {};  ///< for kPats
  int frames_per_second = 15;
};

/// The row of motion frame `frame` >= 0.  Rises with the frame; nothing says that so many rows
/// exist.
std::int64_t RowOfFrame(const RowPlan& plan, std::int64_t frame);

/// The number of motion frames whose rows lie within `rows`.
std::int64_t FramesWithin(const RowPlan& plan, std::int64_t rows);

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_FRAMES_H_
