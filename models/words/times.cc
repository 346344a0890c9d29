#include "models/words/times.h"

#include <array>
#include <string>

#include "models/io/reading.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// No time in any format is longer.
constexpr std::size_t kMaxLength = 40;

bool IsDigits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// "H:MM:SS.fff" or "MM:SS.fff".
bool ParseClock(std::string_view text, double* seconds) {
  double total = 0;
  for (int fields = 0; fields < 2; ++fields) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) break;
    double field = 0;
    if (!IsDigits(text.substr(0, colon)) || !ParseNumber(text.substr(0, colon), &field)) {
      return false;
    }
    total = (total + field) * 60;
    text.remove_prefix(colon + 1);
  }
  double rest = 0;
  const bool starts_with_digit = !text.empty() && text[0] >= '0' && text[0] <= '9';
  if (!starts_with_digit || !ParseNumber(text, &rest)) return false;
  *seconds = total + rest;
  return true;
}

bool TakeSuffix(std::string_view suffix, std::string_view* text) {
  if (text->size() <= suffix.size() || !text->ends_with(suffix)) return false;
  text->remove_suffix(suffix.size());
  return true;
}

}  // namespace

bool ParseTime(std::string_view text, double* seconds) {
  text = Trim(text);
  if (text.empty() || text.size() > kMaxLength) return false;
  std::array<char, kMaxLength> buffer;
  std::string_view number(buffer.data(), text.copy(buffer.data(), kMaxLength));
  const std::size_t comma = number.find(',');
  if (comma != std::string_view::npos && number.find('.') == std::string_view::npos) {
    buffer[comma] = '.';
  }
  if (number.find(':') != std::string_view::npos) return ParseClock(number, seconds);
  const bool milliseconds = TakeSuffix("ms", &number);
  if (!milliseconds) TakeSuffix("s", &number);
  double value = 0;
  if (!ParseNumber(number, &value)) return false;
  *seconds = milliseconds ? value / 1000 : value;
  return true;
}

bool IsNoTime(std::string_view text) {
  text = Trim(text);
  if (text.size() > 4) return false;
  const std::string lower = LowerAscii(text);
  return lower.empty() || lower == "nan" || lower == "none" || lower == "null" || lower == "na" ||
         lower == "-";
}

}  // namespace gestus::words
