#include "models/features/input_stream.h"

#include <algorithm>

#include "models/io/text.h"

namespace gestus::features {

std::string Describe(const words::Transcript& transcript, const std::string& path) {
  return path + ": " + transcript.format + ", " + Count(transcript.words.size(), "word");
}

std::int64_t Stretch(std::int64_t left, std::int64_t unit, std::int64_t most) {
  const std::int64_t whole = std::max<std::int64_t>(1, most / unit) * unit;
  // What would be left behind must fill a unit of its own.
  return left < whole + unit ? left : whole;
}

}  // namespace gestus::features
