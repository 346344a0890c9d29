#include "models/words/text_lines.h"

#include "models/io/text.h"

namespace gestus::words {

std::string_view TakeLine(std::string_view* text) {
  const std::size_t end = text->find_first_of("\r\n");
  const std::string_view line = text->substr(0, end);
  if (end == std::string_view::npos) {
    *text = {};
  } else {
    const bool pair = (*text)[end] == '\r' && end + 1 < text->size() && (*text)[end + 1] == '\n';
    text->remove_prefix(end + (pair ? 2 : 1));
  }
  return line;
}

std::string_view TakeField(std::string_view* line) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t begin = line->find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    *line = {};
    return {};
  }
  line->remove_prefix(begin);
  const std::string_view field = line->substr(0, line->find_first_of(kBlanks));
  line->remove_prefix(field.size());
  return field;
}

Status BadLine(std::size_t number, std::string_view line, const std::string& expected) {
  constexpr std::size_t kQuoted = 60;
  return Status(Code::kBadInput, "line " + std::to_string(number) + ": '" +
                                     OneLine(line.substr(0, 4 * kQuoted), kQuoted) +
                                     "', expected " + expected);
}

}  // namespace gestus::words
