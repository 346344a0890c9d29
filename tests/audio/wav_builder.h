// Makes WAV files, honest and lying ones.
#ifndef GESTUS_TESTS_AUDIO_WAV_BUILDER_H_
#define GESTUS_TESTS_AUDIO_WAV_BUILDER_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gestus::audio {

using ByteVector = std::vector<std::uint8_t>;

inline void Put(ByteVector* to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to->push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline void Put(ByteVector* to, const std::string& text) {
  to->insert(to->end(), text.begin(), text.end());
}

inline void PutChunk(ByteVector* to, const std::string& id, const ByteVector& content) {
  Put(to, id);
  Put(to, content.size(), 4);
  to->insert(to->end(), content.begin(), content.end());
  if (content.size() % 2 != 0) to->push_back(0);
}

/// What a header says; what is not set is said as it is.
struct WavSpec {
  std::uint16_t format = 1, channels = 1, bits = 16;
  std::uint32_t rate = 16000;
  bool extensible = false;
  std::string form = "RIFF";
  std::optional<std::uint32_t> riff_size = {}, data_size = {}, byte_rate = {};
  std::optional<std::uint16_t> block = {};
  ByteVector before_fmt = {}, before_data = {}, after_data = {};  // whole chunks
};

inline ByteVector Fmt(const WavSpec& spec) {
  const auto block = static_cast<std::uint16_t>(spec.channels * ((spec.bits + 7) / 8));
  ByteVector fmt;
  Put(&fmt, spec.extensible ? 0xFFFE : spec.format, 2);
  Put(&fmt, spec.channels, 2);
  Put(&fmt, spec.rate, 4);
  Put(&fmt, spec.byte_rate.value_or(spec.rate * spec.block.value_or(block)), 4);
  Put(&fmt, spec.block.value_or(block), 2);
  Put(&fmt, spec.bits, 2);
  if (spec.extensible) {
    Put(&fmt, 22, 2);         // bytes to follow
    Put(&fmt, spec.bits, 2);  // valid bits
    Put(&fmt, 0, 4);          // speakers
    Put(&fmt, spec.format, 2);
    for (const int byte : {0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71}) {
      fmt.push_back(static_cast<std::uint8_t>(byte));
    }
  }
  return fmt;
}

inline ByteVector Wav(const WavSpec& spec, const ByteVector& data) {
  ByteVector body;
  Put(&body, std::string("WAVE"));
  body.insert(body.end(), spec.before_fmt.begin(), spec.before_fmt.end());
  PutChunk(&body, "fmt ", Fmt(spec));
  body.insert(body.end(), spec.before_data.begin(), spec.before_data.end());
  Put(&body, std::string("data"));
  Put(&body, spec.data_size.value_or(static_cast<std::uint32_t>(data.size())), 4);
  body.insert(body.end(), data.begin(), data.end());
  if (data.size() % 2 != 0 && !spec.after_data.empty()) body.push_back(0);
  body.insert(body.end(), spec.after_data.begin(), spec.after_data.end());
  ByteVector file;
  Put(&file, spec.form);
  Put(&file, spec.riff_size.value_or(static_cast<std::uint32_t>(body.size())), 4);
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

}  // namespace gestus::audio

#endif  // GESTUS_TESTS_AUDIO_WAV_BUILDER_H_
