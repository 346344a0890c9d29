// OpenFace's CSV.
#include "models/motion/openface.h"
#include "tests/fuzz/motion_checks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  static fuzz::MemoryFile file;
  const std::string path = file.Write(data, size);
  // Fewer frames than by default: what follows takes time for each of them.
  auto clip = motion::ReadOpenFace(path, {.max_frames = 5000});
  if (clip.ok()) {
    fuzz::Prepare(&clip->track, motion::CleanOrder::kMedianFirst);
  } else {
    fuzz::RequireSentence(clip.status(), path);
  }
  return 0;
}
