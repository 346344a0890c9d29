// The sample rates that the stages take.  A private header of the front ends.
#ifndef GESTUS_MODELS_AUDIO_RATES_H_
#define GESTUS_MODELS_AUDIO_RATES_H_

#include <string>

#include "engine/status.h"

namespace gestus::audio {

inline Status CheckRate(const char* name, int rate) {
  if (rate >= 1000 && rate <= 384000) return Status();
  return Status(Code::kInvalidArgument,
                std::string(name) + " is " + std::to_string(rate) + " Hz, expected 1000 to 384000");
}

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_RATES_H_
