#include "models/words/json_text.h"

#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// Byte b is written as U+10FF00 + b: the last 128 characters of plane 16, which no text uses.
constexpr char32_t kEscape = 0x10FF00;

// The length of a word at `at` that Python writes and JSON does not know; 0 when there is none.
std::size_t NonFiniteAt(std::string_view bytes, std::size_t at) {
  for (const std::string_view word : {"NaN", "Infinity", "-Infinity"}) {
    if (bytes.substr(at, word.size()) == word) return word.size();
  }
  return 0;
}

// Copies one character of a string, escapes included, and returns how many bytes that was.
std::size_t CopyFromString(std::string_view bytes, std::size_t at, JsonText* to) {
  const char c = bytes[at];
  if (c == '\\' && at + 1 < bytes.size() && static_cast<unsigned char>(bytes[at + 1]) < 0x80) {
    to->text += bytes.substr(at, 2);
    return 2;
  }
  const Character character = DecodeAt(bytes, at);
  if (!character.valid) {
    AppendUtf8(kEscape + static_cast<unsigned char>(c), &to->text);
    to->escaped = true;
  } else if (character.value < 0x20) {
    to->text += ' ';
  } else {
    to->text += bytes.substr(at, character.bytes);
  }
  return character.bytes;
}

}  // namespace

JsonText RepairJson(std::string_view bytes) {
  JsonText result;
  result.text.reserve(bytes.size());
  bool in_string = false;
  for (std::size_t at = 0; at < bytes.size();) {
    const char c = bytes[at];
    if (c == '"') in_string = !in_string;
    if (in_string && c != '"') {
      at += CopyFromString(bytes, at, &result);
      continue;
    }
    const bool may_be_word = !in_string && (c == 'N' || c == 'I' || c == '-');
    const std::size_t word = may_be_word ? NonFiniteAt(bytes, at) : 0;
    if (word > 0) {
      result.text += "null";
    } else {
      result.text += c;
    }
    at += word > 0 ? word : 1;
  }
  return result;
}

std::string RestoreBytes(std::string_view text) {
  std::string restored;
  restored.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Character c = DecodeAt(text, at);
    if (c.valid && c.value >= kEscape + 0x80 && c.value <= kEscape + 0xFF) {
      restored += static_cast<char>(c.value - kEscape);
    } else {
      restored += text.substr(at, c.bytes);
    }
    at += c.bytes;
  }
  return restored;
}

}  // namespace gestus::words
