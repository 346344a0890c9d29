// Tiers of labelled intervals, as Praat and the Montreal Forced Aligner have them in several file
// formats, and which of them hold the words.  A private header of models/words.
#ifndef GESTUS_MODELS_WORDS_TIERS_H_
#define GESTUS_MODELS_WORDS_TIERS_H_

#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"
#include "models/words/draft.h"

namespace gestus::words {

struct Interval {
  Span span;
  std::string text;
};

struct Tier {
  std::string name;
  std::vector<Interval> intervals;
};

/// Whether `label` means that nobody speaks: "", "sil", "sp", "spn", "<eps>" and their like.
bool IsSilenceLabel(std::string_view label);

/// Adds the words of the tiers named "words", one for each speaker; of the first tier that is not
/// of phones when none is so named.
Status AddWordTiers(const std::vector<Tier>& tiers, Draft* draft);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_TIERS_H_
