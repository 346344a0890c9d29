// Messages about options that are out of range.  A private header.
#ifndef GESTUS_MODELS_PROSODY_RANGE_H_
#define GESTUS_MODELS_PROSODY_RANGE_H_

#include <charconv>
#include <string>

#include "engine/status.h"

namespace gestus::prosody {

/// "0.06", "550", "1.2e-09"
inline std::string Plain(double value) {
  char text[32];
  const auto end = std::to_chars(text, std::end(text), value, std::chars_format::general, 6).ptr;
  return std::string(text, end);
}

/// "hop_seconds is 0, expected ..."
inline Status OutOfRange(const char* what, double is, const std::string& expected) {
  return Status(Code::kInvalidArgument,
                std::string(what) + " is " + Plain(is) + ", expected " + expected);
}

}  // namespace gestus::prosody

#endif  // GESTUS_MODELS_PROSODY_RANGE_H_
