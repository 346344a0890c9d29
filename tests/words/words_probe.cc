// Prints what the words front end makes of its input, for words_test.py.
//
//   words_probe read FILE        format, notes, and each word in hexadecimal with its times
//   words_probe frames FILE START FRAMES BY_END
//                                word and piece of each frame; FILE has lines "start end pieces"
#include <charconv>
#include <clocale>
#include <cstdio>
#include <cstring>

#include "models/io/reading.h"
#include "models/words/frames.h"
#include "models/words/transcript.h"

namespace gestus::words {
namespace {

std::string Shortest(double value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, end.ptr);
}

double Number(std::string_view text) {
  double value = 0;
  return ParseNumber(text, &value) ? value : -1;
}

int Fail(const Status& status) {
  std::fprintf(stderr, "%s\n", status.message().c_str());
  return 1;
}

int Read(const char* path) {
  const Result<Transcript> transcript = ReadTranscript(path);
  if (!transcript.ok()) return Fail(transcript.status());
  std::printf("point %s\nformat %s\n", std::localeconv()->decimal_point,
              transcript->format.c_str());
  for (const std::string& note : transcript->notes) std::printf("note %s\n", note.c_str());
  for (const Word& word : transcript->words) {
    std::printf("word ");
    for (const char c : word.text) std::printf("%02x", static_cast<unsigned char>(c));
    std::printf(" %s %s %d\n", Shortest(word.start).c_str(), Shortest(word.end).c_str(),
                word.timed ? 1 : 0);
  }
  return 0;
}

int Frames(char** argv) {
  const Result<std::string> content = ReadFile(argv[0], kMaxTranscriptBytes);
  if (!content.ok()) return Fail(content.status());
  std::vector<Word> words;
  std::vector<std::size_t> pieces;
  for (std::string_view rest = *content; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t first = line.find(' '), second = line.rfind(' ');
    words.push_back(
        {"w", Number(line.substr(0, first)), Number(line.substr(first, second - first))});
    pieces.push_back(static_cast<std::size_t>(Number(line.substr(second))));
  }
  const auto plan = PlaceOnFrames(words, pieces,
                                  {.start = Number(argv[1]),
                                   .frames = static_cast<std::size_t>(Number(argv[2])),
                                   .by_end = std::strcmp(argv[3], "1") == 0});
  if (!plan.ok()) return Fail(plan.status());
  for (const FramePiece& at : plan->frames) std::printf("%d %d\n", at.word, at.piece);
  return 0;
}

int Main(int argc, char** argv) {
  std::setlocale(LC_ALL, "");
  if (argc == 3 && std::strcmp(argv[1], "read") == 0) return Read(argv[2]);
  if (argc == 6 && std::strcmp(argv[1], "frames") == 0) return Frames(argv + 2);
  std::fprintf(stderr, "usage: words_probe read FILE | frames FILE START FRAMES BY_END\n");
  return 2;
}

}  // namespace
}  // namespace gestus::words

int main(int argc, char** argv) { return gestus::words::Main(argc, argv); }
