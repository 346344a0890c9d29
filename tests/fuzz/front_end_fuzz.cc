// What weights files say of how their inputs are made: the way from a short sound and a few words
// to the inputs of their networks.
#include <cmath>
#include <vector>

#include "models/features/front_end.h"
#include "tests/audio/wav_builder.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/weights_bytes.h"

namespace gestus::fuzz {
namespace {

// A fifth of a second of a rising tone.
std::string Sound() {
  audio::ByteVector samples;
  for (int i = 0; i < 3200; ++i) {
    const double phase = 0.05 * i + 1e-5 * i * i;
    audio::Put(&samples, static_cast<std::uint16_t>(std::lround(9000 * std::sin(phase))), 2);
  }
  static MemoryFile file;
  const audio::ByteVector wav = audio::Wav({}, samples);
  return file.Write(wav.data(), wav.size());
}

std::string Words() {
  static MemoryFile file;
  const std::string text = "0.01 0.08 the\n0.08 0.12 cafe.\n0.15 0.19 ab\n";
  return file.Write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

void RequireFinite(const models::Arrays& arrays) {
  for (const auto& [name, array] : arrays) {
    std::size_t elements = 1;
    for (const std::int64_t d : array.shape) elements *= static_cast<std::size_t>(d);
    Require(elements == array.f32.size() + array.i32.size(), "as many elements as the shape says");
    for (const float v : array.f32) Require(std::isfinite(v), "finite inputs");
  }
}

void RequireAnError(const Status& status) {
  Require(status.message().size() > 10 && status.message().size() < 1000, status.message().c_str());
}

void Make(const std::shared_ptr<const WeightsFile>& file, const std::string& name) {
  static const std::string sound = Sound(), words = Words();
  const auto made = features::FrontEnd::Make(file, name, {.max_arena_bytes = 1 << 22});
  if (!made.ok()) return RequireAnError(made.status());
  features::FrontEnd& front_end = **made;
  features::Account account;
  const auto stream = front_end.Open({.audio = sound, .transcript = words}, &account);
  if (!stream.ok()) return RequireAnError(stream.status());
  Require((*stream)->unit() > 0, "a stretch has items");
  for (int i = 0; i < 3; ++i) {
    const auto inputs = (*stream)->Next((*stream)->unit());
    if (!inputs.ok()) return RequireAnError(inputs.status());
    RequireFinite(*inputs);
    if (inputs->empty()) break;
  }
  RequireFinite((*stream)->Beside());
  const auto clip = front_end.StyleClip({.audio = sound, .transcript = words}, &account);
  if (clip.ok()) return RequireFinite(*clip);
  RequireAnError(clip.status());
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  test::Bytes bytes(data, data + size);
  fuzz::MendHeader(&bytes);
  const auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), "fuzzed");
  if (!file.ok()) return 0;
  int networks = 0;
  for (const fb::Network* network : *(*file)->root().networks()) {
    if (++networks > 3) break;
    fuzz::Make(*file, network->name()->str());
  }
  return 0;
}
