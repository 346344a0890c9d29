// Every stage of the front end as arrays, for people who want to see or to keep them.
#ifndef GESTUS_MODELS_FEATURES_STAGES_H_
#define GESTUS_MODELS_FEATURES_STAGES_H_

#include "engine/status.h"
#include "models/features/front_end.h"
#include "models/features/input_stream.h"
#include "models/features/spec.h"
#include "models/network.h"

namespace gestus::features {

/// What can be told without a network.  Times are in milliseconds, int32.
///
///   log_mel (rows, 128)        ln of mel power, spec.sample_rate / 512 rows a second
///   pitch, pitch_strength (n,) Hz (0 unvoiced) and 0 to 1, one value a spec.pitch_hop
///   jitter, shimmer, hnr, hammarberg (n,)   share, dB, dB, dB; times of pitch
///   word_ms (words, 2), word_of_frame (frames,)   -1: no word
///   unit_ms (units, 2)         inter-pausal units
///   body, body_confidence, face_points, face_confidence   as OpenPose has them: PATS' 52 joints
///                              and 70 face points, x of all then y of all, pixels
///   body_clean, face_clean     cleaned, at the motion's rate
///   pose, face                 as the network takes them, where it has joints or landmarks
///   openface, openface_confidence, openface_clean   the columns that the file has
///
/// Without `sound` the first three lines are left out, which take the most time.
Result<models::Arrays> Stages(const Recording& recording, const std::string& openface,
                              const FeatureSpec& spec, Account* account, bool sound = true);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_STAGES_H_
