// Transcripts of every format, and what is made of their words.
#include <cmath>

#include "models/words/frames.h"
#include "models/words/transcript.h"
#include "models/words/units.h"
#include "models/words/utf8.h"
#include "tests/fuzz/fuzz.h"

namespace gestus::fuzz {
namespace {

void RequireOrdered(const std::vector<words::Word>& all) {
  double before = 0;
  std::size_t replaced = 0;
  for (const words::Word& word : all) {
    Require(word.start >= before && word.end >= word.start && std::isfinite(word.end),
            "words follow one another");
    Require(!word.text.empty(), "words are not empty");
    words::RepairUtf8(word.text, &replaced);
    words::Stripped(word.text);
    before = word.end;
  }
  Require(replaced == 0, "words are UTF-8");
}

void Group(const std::vector<words::Word>& all) {
  const auto units = words::MakeUnits(all);
  Require(units.ok(), "words that were read can be grouped");
  std::size_t next = 0;
  for (const words::Unit& unit : *units) {
    Require(unit.first == next && unit.count > 0, "units follow one another");
    next += unit.count;
  }
  Require(next == all.size(), "every word is in a unit");
  next = 0;
  for (const words::Sentence& sentence : words::MakeSentences(all)) {
    Require(sentence.first == next && sentence.count > 0, "sentences follow one another");
    next += sentence.count;
  }
  Require(next == all.size(), "every word is in a sentence");
}

void Place(const std::vector<words::Word>& all) {
  std::vector<std::size_t> pieces;
  for (const words::Word& word : all) pieces.push_back(word.text.size() % 4);
  for (const bool by_end : {false, true}) {
    const auto plan =
        words::PlaceOnFrames(all, pieces, {.start = 0.5, .frames = 100, .by_end = by_end});
    if (!plan.ok()) continue;
    Require(plan->frames.size() == 100, "a piece for each frame");
    for (const words::FramePiece& frame : plan->frames) {
      if (frame.word < 0) continue;
      const auto word = static_cast<std::size_t>(frame.word);
      Require(word < all.size(), "words that there are");
      Require(frame.piece >= 0 && static_cast<std::size_t>(frame.piece) < pieces[word],
              "pieces that there are");
    }
  }
}

}  // namespace
}  // namespace gestus::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gestus;  // NOLINT: this is a test of that library
  const auto transcript =
      words::ParseTranscript({reinterpret_cast<const char*>(data), size}, "fuzzed");
  if (!transcript.ok()) {
    fuzz::RequireSentence(transcript.status(), "fuzzed");
    return 0;
  }
  fuzz::RequireOrdered(transcript->words);
  fuzz::Group(transcript->words);
  fuzz::Place(transcript->words);
  return 0;
}
