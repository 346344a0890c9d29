// A text as words, in one pass.
#include "models/text/words.h"

#include <algorithm>

#include "models/text/unicode.h"

namespace gestus::models {
namespace {

constexpr std::int32_t kCapitalSigma = 0x3A3, kFinalSigma = 0x3C2;

// A run is what lies between white space; it is lowered and decomposed as a whole before it is
// split into words, so a full stop, say, does not hide a letter from a sigma.
class WordReader {
 public:
  WordReader(std::string_view text, const WordRules& rules, const WordSink& sink)
      : text_(text), rules_(rules), sink_(sink) {}

  void ReadAll() {
    while (at_ < text_.size()) ReadChar();
    EndRun();
  }

 private:
  void ReadChar() {
    const Decoded decoded = DecodeUtf8(text_, at_);
    const WordChar c{decoded.value, at_, at_ + decoded.bytes};
    at_ = c.end;
    switch (KindOf(c.value)) {
      case Kind::kDropped:
        break;
      case Kind::kSpace:
        EndRun();
        break;
      case Kind::kIdeograph:
        EndRun();
        Take(c);
        EndRun();
        break;
      case Kind::kPunctuation:
      case Kind::kOther:
        Take(c);
        break;
    }
  }

  void Take(WordChar c) {
    if (!rules_.lower_case) return Put(c);
    const CaseRole role = CaseRoleOf(c.value);
    const bool final_sigma = c.value == kCapitalSigma && after_cased_ && !CasedFollows();
    if (role != CaseRole::kIgnorable) after_cased_ = role == CaseRole::kCased;
    // Python lowers U+0130 to an i and a dot above; the dot would be dropped here like any accent.
    const Decomposition parts = Decompose(final_sigma ? kFinalSigma : Lower(c.value));
    for (std::size_t i = 0; i < parts.count; ++i) PutOrdered({parts.values[i], c.begin, c.end});
  }

  // Whether the next character of the run that is not case-ignorable is cased; what ends a run is
  // neither.  A sigma is itself cased, so no character is looked at for two sigmas.
  bool CasedFollows() const {
    for (std::size_t at = at_; at < text_.size();) {
      const Decoded c = DecodeUtf8(text_, at);
      at += c.bytes;
      const CaseRole role = CaseRoleOf(c.value);
      if (role != CaseRole::kIgnorable && KindOf(c.value) != Kind::kDropped)
        return role == CaseRole::kCased;
    }
    return false;
  }

  // Canonical order sorts the characters between two of class 0 by their classes.  Nearly all of
  // them are accents, which need no sorting because they are dropped.
  void PutOrdered(WordChar c) {
    const bool movable = CombiningClass(c.value) != 0;
    if (!movable) PutMarks();
    if (IsNonspacingMark(c.value)) return;
    if (movable)
      Append(c, &marks_);
    else
      Put(c);
  }

  // Marks that may have changed places share the bytes of all, so that offsets never go back.
  void PutMarks() {
    if (marks_.empty()) return;
    const std::size_t begin = marks_.front().begin, end = marks_.back().end;
    // The order of too many makes no difference: their word is too long in any.
    if (marks_.size() <= rules_.max_chars)
      std::stable_sort(marks_.begin(), marks_.end(), [](const WordChar& a, const WordChar& b) {
        return CombiningClass(a.value) < CombiningClass(b.value);
      });
    for (const WordChar& mark : marks_) Put({mark.value, begin, end});
    marks_.clear();
  }

  void Put(WordChar c) {
    const bool alone = KindOf(c.value) == Kind::kPunctuation;
    if (alone) EndWord();
    Append(c, &word_);
    if (alone) EndWord();
  }

  void Append(WordChar c, std::vector<WordChar>* chars) const {
    if (chars->size() > rules_.max_chars)
      chars->back().end = c.end;
    else
      chars->push_back(c);
  }

  void EndWord() {
    if (word_.empty()) return;
    sink_(word_);
    word_.clear();
  }

  void EndRun() {
    PutMarks();
    EndWord();
    after_cased_ = false;
  }

  const std::string_view text_;
  const WordRules rules_;
  const WordSink& sink_;
  std::size_t at_ = 0;           // the next byte to read
  bool after_cased_ = false;     // the last character of the run that is not ignorable was cased
  std::vector<WordChar> word_;   // the word that grows
  std::vector<WordChar> marks_;  // what the canonical order may still move
};

}  // namespace

void ForEachWord(std::string_view text, const WordRules& rules, const WordSink& sink) {
  WordReader(text, rules, sink).ReadAll();
}

}  // namespace gestus::models
