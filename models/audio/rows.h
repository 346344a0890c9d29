// Whole recordings in one call.
#ifndef GESTUS_MODELS_AUDIO_ROWS_H_
#define GESTUS_MODELS_AUDIO_ROWS_H_

#include <cstddef>
#include <vector>

#include "engine/status.h"
#include "models/audio/source.h"
#include "models/audio/stage.h"

namespace gestus::audio {

/// All rows (n, stage->width()) that `stage` makes of a recording.
std::vector<float> AllRows(Stage* stage, const float* samples, std::size_t n);

/// All rows that `stage` makes of what is left of `source`, resampled to `rate` Hz where it has
/// another.  Only the rows grow with the recording.
Result<std::vector<float>> AllRows(Stage* stage, AudioSource* source, int rate);

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_ROWS_H_
