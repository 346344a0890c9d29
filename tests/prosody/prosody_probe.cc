// Runs a stage of the prosody front end for the tests in Python.
//
// usage: prosody_probe swipe|quality RATE HOP MIN MAX sptk|textbook PIECE < samples > rows
// Samples and rows are raw float32; PIECE is how many samples are pushed at once.
#include <cstdio>
#include <string>
#include <vector>

#include "models/io/reading.h"
#include "models/prosody/swipe.h"
#include "models/prosody/voice_quality.h"

namespace gestus::prosody {
namespace {

std::vector<float> ReadSamples() {
  std::vector<float> samples(1 << 16);
  std::size_t filled = 0;
  while (const std::size_t n =
             std::fread(samples.data() + filled, sizeof(float), samples.size() - filled, stdin)) {
    filled += n;
    samples.resize(2 * filled + (1 << 16));
  }
  samples.resize(filled);
  return samples;
}

template <class Stage>
int Run(Result<Stage> stage, std::size_t piece) {
  if (!stage.ok()) {
    std::fprintf(stderr, "%s\n", stage.status().message().c_str());
    return 2;
  }
  const std::vector<float> samples = ReadSamples();
  constexpr std::size_t kColumns = Stage::kColumns;
  std::vector<float> rows(stage->MaxRows(piece) * kColumns);
  for (std::size_t at = 0; at < samples.size(); at += piece) {
    const std::size_t part = std::min(piece, samples.size() - at);
    const std::size_t n = stage->Push(samples.data() + at, part, rows.data());
    std::fwrite(rows.data(), sizeof(float) * kColumns, n, stdout);
  }
  rows.resize(stage->MaxRowsAtFinish() * kColumns);
  std::fwrite(rows.data(), sizeof(float) * kColumns, stage->Finish(rows.data()), stdout);
  return 0;
}

int Main(int argc, char** argv) {
  double numbers[5] = {};
  const char* const texts[5] = {argv[2], argv[3], argv[4], argv[5], argv[7]};
  for (int i = 0; i < 5; ++i)
    if (argc != 8 || !ParseNumber(texts[i], &numbers[i])) return 1;
  SwipeOptions o{.sample_rate = numbers[0],
                 .hop_seconds = numbers[1],
                 .min_hz = numbers[2],
                 .max_hz = numbers[3]};
  o.mode = std::string(argv[6]) == "sptk" ? SwipeMode::kSptk : SwipeMode::kTextbook;
  const auto piece = static_cast<std::size_t>(numbers[4]);
  if (std::string(argv[1]) == "swipe") return Run(Swipe::Make(o), piece);
  return Run(VoiceQuality::Make({.swipe = o}), piece);
}

}  // namespace
}  // namespace gestus::prosody

int main(int argc, char** argv) { return argc == 8 ? gestus::prosody::Main(argc, argv) : 1; }
