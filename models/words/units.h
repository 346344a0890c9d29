// Words grouped as the networks take them: inter-pausal units in windows of a few words (Models 1
// and 2), and sentences (dialog tags).
#ifndef GESTUS_MODELS_WORDS_UNITS_H_
#define GESTUS_MODELS_WORDS_UNITS_H_

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/words/transcript.h"

namespace gestus::words {

struct UnitOptions {
  /// Seconds; a longer silence ends a unit (thesis, section 5.6.1).  Exactly as long does not.
  double pause = 0.2;
  /// Whether shorter silences are items of their own, which the network reads as ",".
  bool commas = true;
  /// Seconds; what is shorter is rounding of times rather than silence.
  double shortest_silence = 0.01;
  /// Items of a window, commas counted; 0 for units without a limit.
  std::size_t max_items = 10;
};

/// A word, or a silence between two words of a unit.
struct UnitItem {
  /// Index of the word; kComma for a silence.
  std::size_t word;
  double start, end;  ///< seconds

  static constexpr std::size_t kComma = std::numeric_limits<std::size_t>::max();
  bool is_comma() const { return word == kComma; }
};

/// Neighbouring words [first, first + count), count > 0.  Begins and ends with a word.
struct Unit {
  std::size_t first, count;
  double start, end;  ///< seconds, of the first and the last word
  std::vector<UnitItem> items;
};

/// The units of `words`, which are sorted and do not overlap, as ReadTranscript() leaves them.
/// Where a unit has too many items it goes on in further windows; a silence between two windows
/// belongs to neither.
Result<std::vector<Unit>> MakeUnits(const std::vector<Word>& words,
                                    const UnitOptions& options = {});

struct SentenceOptions {
  double pause = 0.2;          ///< seconds, as above
  std::size_t max_words = 40;  ///< what is longer is split at its pauses
};

struct Sentence {
  std::size_t first, count;
  double start, end;  ///< seconds
  std::string text;   ///< the words with a blank between them
};

/// Sentences end at words that end in . ? ! or their like in other scripts, quotes and brackets
/// aside, but not at "Dr." or an initial.  A sentence of more than `max_words`, and every sentence
/// of a transcript in which none ends so, is split where a pause is.
std::vector<Sentence> MakeSentences(const std::vector<Word>& words,
                                    const SentenceOptions& options = {});

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_UNITS_H_
