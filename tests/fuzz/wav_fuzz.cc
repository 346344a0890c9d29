// WAV files, read to their end in pieces.  This build has no libsndfile, so that only our own
// reader is called.
#include <cmath>
#include <vector>

#include "models/audio/source.h"
#include "tests/fuzz/fuzz.h"

namespace gestus::fuzz {
namespace {

void ReadAll(audio::AudioSource* source, const std::string& path, std::size_t file_bytes) {
  Require(source->sample_rate() > 0 && source->channels() > 0, "a rate and channels");
  std::vector<float> piece(1000);
  std::size_t total = 0, ask = 1;
  while (true) {
    const auto got = source->Read(piece.data(), ask);
    if (!got.ok()) return RequireSentence(got.status(), path);
    Require(*got <= ask, "no more samples than asked for");
    for (std::size_t i = 0; i < *got; ++i) Require(std::isfinite(piece[i]), "finite samples");
    total += *got;
    Require(total <= file_bytes, "no more samples than bytes");
    if (*got == 0) break;
    ask = (ask * 7 + 1) % piece.size() + 1;
  }
  Require(source->frames() < 0 || static_cast<std::size_t>(source->frames()) == total,
          "as many samples as were said");
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  static fuzz::MemoryFile file;
  const std::string path = file.Write(data, size);
  const auto source = audio::OpenAudio(path);
  if (source.ok()) {
    fuzz::ReadAll(source->get(), path, size);
  } else {
    fuzz::RequireSentence(source.status(), path);
  }
  return 0;
}
