// std::to_chars is used for every number with a point: printf would follow the locale.
#include "models/io/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace gestus {
namespace {

// Bytes of the UTF-8 character at the start of `text`; 0 when there is none, or one that a
// terminal should not see (C0 and C1 controls, and the marks that reorder or hide text).
std::size_t PrintableLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  char32_t code = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    code = (code << 6) | (byte(i) & 0x3fU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  const bool control = code < 0xa0;
  const bool reorders = (code >= 0x200b && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
                        (code >= 0x2060 && code <= 0x206f) || code == 0xfeff;
  return overlong || surrogate || control || reorders || code > 0x10ffff ? 0 : length;
}

std::string Escape(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out;
  while (!text.empty()) {
    const std::size_t length = PrintableLength(text);
    if (length > 0) {
      out += text.substr(0, length);
    } else {
      const auto byte = static_cast<unsigned char>(text[0]);
      out += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

bool InsideCharacter(const std::string& text, std::size_t at) {
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80U;
}

std::string ToChars(double value, std::chars_format format, int digits) {
  std::array<char, 400> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, digits);
  return std::string(buffer.data(), result.ptr);
}

// Columns on a terminal, taking every character for one.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
  }));
}

}  // namespace

std::string OneLine(std::string_view text, std::size_t max_bytes) {
  std::string line = Escape(text);
  if (line.size() <= max_bytes) return line;
  // What is long is the path in front; the end says what was expected.
  constexpr std::string_view kGap = "...";
  std::size_t head = (max_bytes - kGap.size()) / 3;
  std::size_t tail = line.size() - (max_bytes - kGap.size() - head);
  while (head > 0 && InsideCharacter(line, head)) --head;
  while (InsideCharacter(line, tail)) ++tail;
  return line.substr(0, head) + std::string(kGap) + line.substr(tail);
}

std::string Fixed(double value, int digits) {
  return ToChars(value, std::chars_format::fixed, digits);
}

std::string Significant(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return Fixed(value, 0);
  const int magnitude = static_cast<int>(std::floor(std::log10(std::fabs(value))));
  if (magnitude < -5 || magnitude > 15) return ToChars(value, std::chars_format::general, digits);
  return Fixed(value, std::max(0, digits - 1 - magnitude));
}

std::string Bytes(std::uint64_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " B";
  static constexpr const char* kUnits[] = {"kB", "MB", "GB", "TB"};
  double value = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < std::size(kUnits); ++unit) value /= 1000;
  return Significant(value, 3) + " " + kUnits[unit];
}

std::string Grouped(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

std::string Seconds(double seconds) {
  if (seconds >= 1) return Significant(seconds, 3) + " s";
  if (seconds >= 1e-3) return Significant(seconds * 1e3, 3) + " ms";
  return Significant(seconds * 1e6, 3) + " us";
}

std::string Count(std::uint64_t n, const std::string& noun) {
  return Grouped(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string Table(const std::vector<std::vector<std::string>>& rows,
                  const std::vector<std::size_t>& right_aligned, const std::string& indent) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string pad(widths[i] - Width(row[i]), ' ');
      const bool right =
          std::find(right_aligned.begin(), right_aligned.end(), i) != right_aligned.end();
      line += (i == 0 ? "" : "  ") + (right ? pad + row[i] : row[i] + pad);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace gestus
