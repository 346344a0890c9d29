// The markup of WebVTT (W3C, section 6.5), which SRT files share as far as they have any.
#include "models/words/cue_text.h"

#include <utility>

#include "models/io/reading.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

constexpr std::size_t kMaxEntity = 10;

constexpr std::pair<std::string_view, std::string_view> kEntities[] = {
    {"amp", "&"},  {"lt", "<"},        {"gt", ">"},       {"quot", "\""},
    {"apos", "'"}, {"nbsp", "\u00A0"}, {"lrm", "\u200E"}, {"rlm", "\u200F"}};

// The code point of "#39" or "#x27"; 0 when that is none.
char32_t NumericEntity(std::string_view name) {
  if (name.size() < 2 || name[0] != '#') return 0;
  const bool hex = name[1] == 'x' || name[1] == 'X';
  const std::string_view digits = name.substr(hex ? 2 : 1);
  char32_t value = 0;
  for (const char c : digits) {
    const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool decimal = lower >= '0' && lower <= '9';
    if (!decimal && !(hex && lower >= 'a' && lower <= 'f')) return 0;
    const int digit = decimal ? lower - '0' : lower - 'a' + 10;
    value = value * (hex ? 16 : 10) + static_cast<char32_t>(digit);
    if (value > 0x10FFFF) return 0;
  }
  return value >= 0xD800 && value < 0xE000 ? 0 : value;
}

// Takes one line apart from left to right.
class LineParser {
 public:
  explicit LineParser(std::string_view line)
      : line_(line), next_angle_(line.find('>')), next_brace_(line.find('}')) {}

  std::vector<CuePart> Parse() {
    while (at_ < line_.size()) {
      if (!TakeTag() && !TakeOverride() && !TakeEntity() && !TakeNote()) {
        parts_.back().text += line_[at_++];
      }
    }
    return std::move(parts_);
  }

 private:
  // The first `c` at or behind at_; a line of nothing but "<" is searched only once.
  std::size_t Next(char c, std::size_t* cached) {
    if (*cached != std::string_view::npos && *cached < at_) *cached = line_.find(c, at_);
    return *cached;
  }

  bool TakeTag() {
    if (line_[at_] != '<' || at_ + 1 == line_.size()) return false;
    const char next = line_[at_ + 1];
    const bool letter = (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z');
    const bool digit = next >= '0' && next <= '9';
    // "3 < 4" is text.
    if (!letter && !digit && next != '/') return false;
    const std::size_t close = Next('>', &next_angle_);
    if (close == std::string_view::npos) return false;
    double time = 0;
    if (digit) {
      const std::string_view inside = line_.substr(at_ + 1, close - at_ - 1);
      if (inside.find(':') == std::string_view::npos || !ParseTime(inside, &time)) return false;
      parts_.push_back({time, {}});
    }
    at_ = close + 1;
    return true;
  }

  // "{\an8}" of the SubStation formats.
  bool TakeOverride() {
    if (line_.substr(at_, 2) != "{\\") return false;
    const std::size_t close = Next('}', &next_brace_);
    if (close == std::string_view::npos) return false;
    at_ = close + 1;
    return true;
  }

  bool TakeEntity() {
    if (line_[at_] != '&') return false;
    const std::string_view rest = line_.substr(at_ + 1, kMaxEntity);
    const std::size_t end = rest.find(';');
    if (end == std::string_view::npos) return false;
    const std::string_view name = rest.substr(0, end);
    std::string& text = parts_.back().text;
    const std::size_t before = text.size();
    for (const auto& [entity, meaning] : kEntities) {
      if (name == entity) text += meaning;
    }
    if (const char32_t value = NumericEntity(name)) AppendUtf8(value, &text);
    if (text.size() == before) return false;
    at_ += end + 2;
    return true;
  }

  // Notes around the words of a song.
  bool TakeNote() {
    for (const std::string_view note : {"\u2669", "\u266A", "\u266B", "\u266C"}) {
      if (line_.substr(at_, note.size()) != note) continue;
      parts_.back().text += ' ';
      at_ += note.size();
      return true;
    }
    return false;
  }

  std::string_view line_;
  std::size_t at_ = 0;
  std::size_t next_angle_, next_brace_;
  std::vector<CuePart> parts_ = {CuePart{}};
};

}  // namespace

std::vector<CuePart> ParseCueLine(std::string_view line) { return LineParser(line).Parse(); }

std::string PlainText(const std::vector<CuePart>& parts) {
  std::string text;
  for (const CuePart& part : parts) text += part.text;
  return std::string(TrimSpace(text));
}

}  // namespace gestus::words
