// A track at another frame rate.
#ifndef GESTUS_MODELS_MOTION_RESAMPLE_H_
#define GESTUS_MODELS_MOTION_RESAMPLE_H_

#include "engine/status.h"
#include "models/motion/clip.h"

namespace gestus::motion {

/// `track` at `rate` frames per second.  Frame i is the straight line between the two frames around
/// time i / rate (frame k of `track` stands at k / its rate), the last frame held beyond the end.
/// There are as many frames as begin before the track ends: floor(frames * rate / its rate), at
/// least one.  A point's confidence is the lower one of the two.
///
/// Errors: a rate outside of 1 to 1000; a track without frames.
Result<Track> Resample(const Track& track, double rate);

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_RESAMPLE_H_
