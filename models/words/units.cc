#include "models/words/units.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/io/text.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// 0.8 - 0.6 is a little more than 0.2 in binary; times are never that exact.
constexpr double kRounding = 1e-6;

double SilenceBefore(const std::vector<Word>& words, std::size_t i) {
  return words[i].start - words[i - 1].end;
}

bool IsPauseBefore(const std::vector<Word>& words, std::size_t i, double pause) {
  return SilenceBefore(words, i) > pause + kRounding;
}

Unit OneWord(const std::vector<Word>& words, std::size_t i) {
  return {i, 1, words[i].start, words[i].end, {{i, words[i].start, words[i].end}}};
}

bool IsSentenceEnd(char32_t c) {
  for (const char32_t end : U".?!\u2026\u3002\uFF0E\uFF01\uFF1F\u061F\u06D4\u0964\u0965\u203D") {
    if (c == end && end != 0) return true;
  }
  return false;
}

// Quotes, brackets and marks of direction that may stand behind the end of a sentence.
bool IsClosing(char32_t c) {
  return IsPunctuation(c) && !IsSentenceEnd(c) && c != ',' && c != ';' && c != ':' && c != '-';
}

bool IsAbbreviation(std::string_view word) {
  const std::string_view bare = Stripped(word);
  // An initial, "J.", but not the digit of "in 4."
  if (bare.size() == 1) return bare[0] >= 'A' && bare[0] <= 'Z' && bare[0] != 'I';
  if (bare.size() > 5) return false;
  const std::string lower = LowerAscii(bare);
  for (const char* known :
       {"mr", "mrs", "ms", "dr", "prof", "st", "vs", "e.g", "i.e", "jr", "sr"}) {
    if (lower == known) return true;
  }
  return false;
}

bool EndsSentence(std::string_view word) {
  std::size_t end = word.size();
  while (end > 0) {
    const Character c = DecodeBefore(word, end);
    if (IsSentenceEnd(c.value)) return c.value != '.' || !IsAbbreviation(word);
    if (!IsClosing(c.value)) return false;
    end -= c.bytes;
  }
  return false;
}

Sentence MakeSentence(const std::vector<Word>& words, std::size_t first, std::size_t last) {
  Sentence sentence{first, last - first, words[first].start, words[last - 1].end, {}};
  for (std::size_t i = first; i < last; ++i) {
    if (i > first) sentence.text += ' ';
    sentence.text += words[i].text;
  }
  return sentence;
}

}  // namespace

Result<std::vector<Unit>> MakeUnits(const std::vector<Word>& words, const UnitOptions& options) {
  if (!(options.pause >= 0) || !(options.shortest_silence >= 0)) {
    return Status(Code::kInvalidArgument,
                  "pause is " + Significant(options.pause, 4) + " s and the shortest silence " +
                      Significant(options.shortest_silence, 4) + " s, but neither may be negative");
  }
  const std::size_t limit =
      options.max_items == 0 ? std::numeric_limits<std::size_t>::max() : options.max_items;
  std::vector<Unit> units;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i == 0 || IsPauseBefore(words, i, options.pause)) {
      units.push_back(OneWord(words, i));
      continue;
    }
    Unit& unit = units.back();
    const bool comma = options.commas &&
                       SilenceBefore(words, i) >= options.shortest_silence - kRounding &&
                       SilenceBefore(words, i) > 0;
    if (unit.items.size() + (comma ? 2 : 1) > limit) {
      units.push_back(OneWord(words, i));
      continue;
    }
    if (comma) unit.items.push_back({UnitItem::kComma, words[i - 1].end, words[i].start});
    unit.items.push_back({i, words[i].start, words[i].end});
    unit.end = words[i].end;
    ++unit.count;
  }
  return units;
}

std::vector<Sentence> MakeSentences(const std::vector<Word>& words,
                                    const SentenceOptions& options) {
  const bool punctuated = std::any_of(words.begin(), words.end(),
                                      [](const Word& word) { return EndsSentence(word.text); });
  std::vector<Sentence> sentences;
  for (std::size_t first = 0; first < words.size();) {
    std::size_t last = first + 1;
    while (last < words.size() && !EndsSentence(words[last - 1].text)) ++last;
    const bool at_pauses = !punctuated || last - first > options.max_words;
    std::size_t begin = first;
    for (std::size_t i = first + 1; i <= last; ++i) {
      if (i < last && !(at_pauses && IsPauseBefore(words, i, options.pause))) continue;
      sentences.push_back(MakeSentence(words, begin, i));
      begin = i;
    }
    first = last;
  }
  return sentences;
}

}  // namespace gestus::words
