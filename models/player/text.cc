#include "models/player/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace gestus::player {
namespace {

constexpr std::string_view kUnknown = "\xef\xbf\xbd";  // U+FFFD

/// Length of the UTF-8 character at the start of `text`, which is not empty; 0: there is none.
std::size_t CharacterLength(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  char32_t code = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0U) != 0x80U) return 0;
    code = (code << 6) | (byte & 0x3fU);
  }
  if ((length == 3 && code < 0x800) || (length == 4 && (code < 0x10000 || code > 0x10ffff)))
    return 0;
  // Surrogates, and the two that XML leaves out.
  if ((code >= 0xd800 && code <= 0xdfff) || code == 0xfffe || code == 0xffff) return 0;
  return length;
}

/// Calls `put` with each character of `text`.
template <class Put>
void ForEachCharacter(std::string_view text, Put put) {
  while (!text.empty()) {
    const std::size_t length = CharacterLength(text);
    put(length == 0 ? kUnknown : text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
}

std::string Shortest(double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return std::string(buffer.data(), end);
}

}  // namespace

std::string Escaped(std::string_view text) {
  std::string out;
  ForEachCharacter(text, [&](std::string_view character) {
    const char c = character[0];
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += c == '\t' || c == '\n' || c == '\r' ? std::string_view(" ") : kUnknown;
    } else {
      out += character;
    }
  });
  return out;
}

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (i < n ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i) out += i <= n ? kDigits[group >> (18 - 6 * i) & 63U] : '=';
  }
  return out;
}

ScriptJson& ScriptJson::Open(char bracket) {
  if (comma_) text_ += ',';
  text_ += bracket;
  comma_ = false;
  return *this;
}

ScriptJson& ScriptJson::Close(char bracket) {
  text_ += bracket;
  comma_ = true;
  return *this;
}

ScriptJson& ScriptJson::Token(std::string_view token) {
  if (comma_) text_ += ',';
  text_ += token;
  comma_ = true;
  return *this;
}

ScriptJson& ScriptJson::Key(std::string_view key) {
  Text(key);
  text_ += ':';
  comma_ = false;
  return *this;
}

ScriptJson& ScriptJson::Text(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  ForEachCharacter(text, [&](std::string_view character) {
    const auto c = static_cast<unsigned char>(character[0]);
    if (c == '"' || c == '\\') {
      out += {'\\', static_cast<char>(c)};
    } else if (c < 0x20 || c == 0x7f || c == '<' || c == '>' || c == '&') {
      out += {'\\', 'u', '0', '0', kHex[c >> 4], kHex[c & 15U]};
    } else {
      out += character;
    }
  });
  return Token(out + "\"");
}

ScriptJson& ScriptJson::Number(double value) {
  const double rounded = std::round(value * 1e6) / 1e6;
  return Exact(rounded);
}

ScriptJson& ScriptJson::Exact(double value) {
  return Token(std::isfinite(value) ? Shortest(value) : "0");
}

ScriptJson& ScriptJson::Packed(std::span<const std::uint8_t> values) {
  return Token('"' + Base64({reinterpret_cast<const char*>(values.data()), values.size()}) + '"');
}

ScriptJson& ScriptJson::Packed(std::span<const std::int16_t> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  for (const std::int16_t value : values) {
    const auto bits = static_cast<std::uint16_t>(value);
    bytes.push_back(static_cast<std::uint8_t>(bits & 255U));
    bytes.push_back(static_cast<std::uint8_t>(bits >> 8));
  }
  return Packed(bytes);
}

}  // namespace gestus::player
