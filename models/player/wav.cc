// The format: Microsoft and IBM, Multimedia Programming Interface and Data Specifications 1.0
// (1991).
#include "models/player/wav.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gestus::player {
namespace {

void Put(std::string* out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) *out += static_cast<char>(value >> (8 * i) & 255U);
}

/// `bytes` of them at `at`, which lie within `file`.
std::uint32_t Get(std::string_view file, std::size_t at, int bytes) {
  std::uint32_t value = 0;
  for (int i = bytes - 1; i >= 0; --i)
    value = value << 8 | static_cast<unsigned char>(file[at + static_cast<std::size_t>(i)]);
  return value;
}

}  // namespace

std::string MakeWav(std::span<const float> samples, int sample_rate) {
  const auto rate = static_cast<std::uint32_t>(sample_rate);
  const auto bytes = static_cast<std::uint32_t>(2 * samples.size());
  std::string out = "RIFF";
  out.reserve(44 + bytes);
  Put(&out, 36 + bytes, 4);
  out += "WAVEfmt ";
  Put(&out, 16, 4);
  Put(&out, 1, 2);  // PCM
  Put(&out, 1, 2);  // channels
  Put(&out, rate, 4);
  Put(&out, 2 * rate, 4);  // bytes a second
  Put(&out, 2, 2);         // bytes a frame
  Put(&out, 16, 2);        // bits
  out += "data";
  Put(&out, bytes, 4);
  for (const float sample : samples) {
    const float finite = std::isfinite(sample) ? std::clamp(sample, -1.0f, 1.0f) : 0.0f;
    Put(&out, static_cast<std::uint32_t>(std::lround(finite * 32767.0f)), 2);
  }
  return out;
}

bool IsPlainWav(std::string_view file) {
  if (file.size() < 44 || file.substr(0, 4) != "RIFF" || file.substr(8, 4) != "WAVE" ||
      Get(file, 4, 4) != file.size() - 8)
    return false;
  bool format = false;
  for (std::size_t at = 12; at + 8 <= file.size();) {
    const std::string_view name = file.substr(at, 4);
    const std::size_t size = Get(file, at + 4, 4);
    at += 8;
    if (size > file.size() - at) return false;
    if (name == "fmt " && size >= 16) {
      const std::uint32_t channels = Get(file, at + 2, 2), rate = Get(file, at + 4, 4);
      format = Get(file, at, 2) == 1 && (channels == 1 || channels == 2) && rate >= 8000 &&
               rate <= 48000 && Get(file, at + 12, 2) == 2 * channels &&
               Get(file, at + 14, 2) == 16;
      if (!format) return false;
    }
    if (name == "data") return format;
    at += size + size % 2;
  }
  return false;
}

}  // namespace gestus::player
