// The f0 contour of a whole recording.
#ifndef GESTUS_MODELS_FEATURES_PITCH_H_
#define GESTUS_MODELS_FEATURES_PITCH_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/features/spec.h"
#include "models/prosody/swipe.h"

namespace gestus::features {

/// 800 bytes for each second of the recording at the default hop.
struct Pitch {
  std::vector<float> f0;        ///< Hz, one value a hop; 0 where unvoiced
  std::vector<float> strength;  ///< of the best candidate, 0 to 1
  double seconds = 0;           ///< of the recording
  std::string description;      ///< "26.7 s, 16000 Hz"
  std::vector<std::string> notes;
};

prosody::SwipeOptions SwipeOptionsOf(const FeatureSpec& spec);

/// SWIPE' as the spec says (thesis 5.3).  Errors begin with the path; one of them is a recording
/// without samples.
Result<Pitch> ReadPitch(const std::string& path, const FeatureSpec& spec);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_PITCH_H_
