// Praat's TextGrid, in the long and the short text form.  Praat itself reads both the same way: of
// all text only free-standing numbers, quoted strings and <flags> count; the names before them are
// there for people, and "!" begins a comment.
#include <optional>

#include "models/io/reading.h"
#include "models/words/formats.h"
#include "models/words/tiers.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// The values of a file, one after the other.
class Values {
 public:
  explicit Values(std::string_view text) : text_(text) {}

  std::size_t line() {
    for (; counted_ < at_ && counted_ < text_.size(); ++counted_) line_ += text_[counted_] == '\n';
    return line_;
  }

  /// The next value when it is a string; "" within stands for ".
  std::optional<std::string> String() {
    if (!SkipToValue() || text_[at_] != '"') return std::nullopt;
    std::string value;
    for (std::size_t at = at_ + 1; at < text_.size(); ++at) {
      if (text_[at] == '"') {
        if (at + 1 == text_.size() || text_[at + 1] != '"') {
          at_ = at + 1;
          return value;
        }
        ++at;
      }
      value += text_[at];
    }
    return std::nullopt;  // it never ends
  }
  std::optional<double> Number() {
    double value = 0;
    if (!SkipToValue() || text_[at_] == '"' || !ParseNumber(Word(), &value)) return std::nullopt;
    at_ += Word().size();
    return value;
  }
  /// <exists> or <absent>.
  std::optional<bool> Flag() {
    if (!SkipToValue() || text_[at_] != '<') return std::nullopt;
    const std::string_view word = Word();
    at_ += word.size();
    return word == "<exists>";
  }

 private:
  std::string_view Word() const {
    const std::size_t end = text_.find_first_of(kBlanks, at_);
    return text_.substr(at_, end == std::string_view::npos ? end : end - at_);
  }
  bool IsValue(std::string_view word) const {
    double number = 0;
    return word[0] == '"' || word[0] == '<' || ParseNumber(word, &number);
  }
  // Leaves at_ at the next value; false at the end of the text.
  bool SkipToValue() {
    while (true) {
      at_ = text_.find_first_not_of(kBlanks, at_);
      if (at_ >= text_.size()) {
        at_ = text_.size();
        return false;
      }
      if (text_[at_] == '!') {
        at_ = text_.find('\n', at_);
        continue;
      }
      const std::string_view word = Word();
      if (IsValue(word)) return true;
      at_ += word.size();
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0, line_ = 1;  // how far the lines are counted
};

Status Expected(Values* values, const std::string& what) {
  return Status(Code::kBadInput, "line " + std::to_string(values->line()) + ": expected " + what);
}

// The intervals of a tier, or the points of one whose words are not wanted.
Status ReadEntries(Values* values, bool intervals, std::size_t number, Tier* tier) {
  const std::string where = "tier " + std::to_string(number) + ": ";
  const auto size = values->Number();
  if (!size || !(*size >= 0)) return Expected(values, where + "the number of its entries");
  for (double i = 0; i < *size; ++i) {
    const auto start = values->Number();
    const auto end = intervals ? values->Number() : start;
    if (!start || !end) return Expected(values, where + "the time of an entry, a number");
    auto text = values->String();
    if (!text) return Expected(values, where + "the text of an entry, in quotes");
    if (intervals) tier->intervals.push_back({{*start, *end}, *std::move(text)});
  }
  return Status();
}

Status ReadTiers(Values* values, std::vector<Tier>* tiers) {
  if (!values->Number() || !values->Number()) return Expected(values, "the start and end, numbers");
  const auto exists = values->Flag();
  if (!exists) return Expected(values, "<exists> or <absent>");
  if (!*exists) return Status();
  const auto size = values->Number();
  if (!size || !(*size >= 0)) return Expected(values, "the number of tiers");
  for (double i = 0; i < *size; ++i) {
    const auto kind = values->String();
    const bool intervals = kind && *kind == "IntervalTier";
    if (!intervals && !(kind && *kind == "TextTier")) {
      return Expected(values, "\"IntervalTier\" or \"TextTier\"");
    }
    auto name = values->String();
    if (!name) return Expected(values, "the name of a tier, in quotes");
    if (!values->Number() || !values->Number()) {
      return Expected(values, "the start and end of a tier, numbers");
    }
    Tier tier{*std::move(name), {}};
    const auto number = static_cast<std::size_t>(i) + 1;
    GESTUS_RETURN_IF_ERROR(ReadEntries(values, intervals, number, &tier));
    if (intervals) tiers->push_back(std::move(tier));
  }
  return Status();
}

}  // namespace

bool LooksLikeTextGrid(std::string_view text) {
  const std::string_view head = text.substr(0, 400);
  return head.find("ooTextFile") != std::string_view::npos || head.substr(0, 12) == "ooBinaryFile";
}

Result<Draft> ReadTextGrid(std::string_view text) {
  if (text.substr(0, 12) == "ooBinaryFile") {
    return Status(Code::kBadInput,
                  "is a binary Praat file, expected a TextGrid saved as text (Save as text file)");
  }
  Values values(text);
  const auto type = values.String(), object = values.String();
  if (!type || *type != "ooTextFile" || !object || *object != "TextGrid") {
    return Status(Code::kBadInput, "is a Praat file of another kind, expected a TextGrid");
  }
  std::vector<Tier> tiers;
  GESTUS_RETURN_IF_ERROR(ReadTiers(&values, &tiers));
  Draft draft("Praat TextGrid");
  if (!tiers.empty()) GESTUS_RETURN_IF_ERROR(AddWordTiers(tiers, &draft));
  return draft;
}

}  // namespace gestus::words
