// UTF-8 after RFC 3629; the ranges of punctuation and white space are Unicode's.
#include "models/words/utf8.h"

#include <algorithm>
#include <iterator>

namespace gestus::words {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

struct Range {
  char32_t first, last;
};

// Category P* outside ASCII as far as transcripts use it, and the marks of writing direction, which
// nobody sees or says.
constexpr Range kPunctuation[] = {
    {0xA1, 0xA1},     {0xAB, 0xAB},     {0xB6, 0xB7},     {0xBB, 0xBB},     {0xBF, 0xBF},
    {0x37E, 0x37E},   {0x387, 0x387},   {0x55A, 0x55F},   {0x589, 0x58A},   {0x5BE, 0x5BE},
    {0x5C0, 0x5C0},   {0x5C3, 0x5C3},   {0x5C6, 0x5C6},   {0x5F3, 0x5F4},   {0x60C, 0x60D},
    {0x61B, 0x61B},   {0x61E, 0x61F},   {0x66A, 0x66D},   {0x6D4, 0x6D4},   {0x964, 0x965},
    {0x970, 0x970},   {0xE4F, 0xE4F},   {0xE5A, 0xE5B},   {0x104A, 0x104F}, {0x1362, 0x1368},
    {0x17D4, 0x17D6}, {0x200B, 0x200B}, {0x200E, 0x200F}, {0x2010, 0x2027}, {0x202A, 0x202E},
    {0x2030, 0x205E}, {0x2066, 0x2069}, {0x2E00, 0x2E4F}, {0x3001, 0x3003}, {0x3008, 0x3011},
    {0x3014, 0x301F}, {0x30FB, 0x30FB}, {0xFE10, 0xFE19}, {0xFE30, 0xFE52}, {0xFEFF, 0xFEFF},
    {0xFF01, 0xFF03}, {0xFF05, 0xFF0A}, {0xFF0C, 0xFF0F}, {0xFF1A, 0xFF1B}, {0xFF1F, 0xFF20},
    {0xFF3B, 0xFF3D}, {0xFF3F, 0xFF3F}, {0xFF5B, 0xFF5B}, {0xFF5D, 0xFF5D}, {0xFF5F, 0xFF65}};
constexpr Range kSpaces[] = {{0x9, 0xD},       {0x20, 0x20},     {0x85, 0x85},     {0xA0, 0xA0},
                             {0x1680, 0x1680}, {0x2000, 0x200A}, {0x2028, 0x2029}, {0x202F, 0x202F},
                             {0x205F, 0x205F}, {0x3000, 0x3000}};
constexpr Range kIdeographs[] = {{0x3005, 0x3007}, {0x3040, 0x30FA},  {0x30FC, 0x30FF},
                                 {0x31F0, 0x31FF}, {0x3400, 0x4DBF},  {0x4E00, 0x9FFF},
                                 {0xF900, 0xFAFF}, {0x20000, 0x3FFFD}};

template <std::size_t n>
bool In(const Range (&ranges)[n], char32_t value) {
  const Range* range = std::lower_bound(std::begin(ranges), std::end(ranges), value,
                                        [](const Range& r, char32_t v) { return r.last < v; });
  return range != std::end(ranges) && range->first <= value;
}

unsigned ByteAt(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

char32_t UnitAt(std::string_view bytes, std::size_t at, bool big_endian) {
  const unsigned first = ByteAt(bytes, at), second = ByteAt(bytes, at + 1);
  return big_endian ? first << 8 | second : second << 8 | first;
}

std::string FromUtf16(std::string_view bytes, bool big_endian) {
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    char32_t value = UnitAt(bytes, at, big_endian);
    if (value >= 0xD800 && value < 0xDC00 && at + 3 < bytes.size()) {
      const char32_t low = UnitAt(bytes, at + 2, big_endian);
      if (low >= 0xDC00 && low < 0xE000) {
        value = 0x10000 + ((value - 0xD800) << 10) + (low - 0xDC00);
        at += 2;
      }
    }
    AppendUtf8(value >= 0xD800 && value < 0xE000 ? kReplacement : value, &text);
  }
  return text;
}

}  // namespace

Character DecodeAt(std::string_view text, std::size_t at) {
  const unsigned first = ByteAt(text, at);
  if (first < 0x80) return {first, 1, true};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  constexpr Character kInvalid = {kReplacement, 1, false};
  if (first < 0xC2 || first > 0xF4 || text.size() - at < bytes) return kInvalid;
  char32_t value = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    const unsigned byte = ByteAt(text, at + i);
    if ((byte & 0xC0U) != 0x80U) return kInvalid;
    value = value << 6 | (byte & 0x3FU);
  }
  const bool overlong = (bytes == 3 && value < 0x800) || (bytes == 4 && value < 0x10000);
  const bool no_character = (value >= 0xD800 && value < 0xE000) || value > 0x10FFFF;
  if (overlong || no_character) return kInvalid;
  return {value, bytes, true};
}

Character DecodeBefore(std::string_view text, std::size_t end) {
  for (std::size_t bytes = 1; bytes <= 4 && bytes <= end; ++bytes) {
    const Character c = DecodeAt(text.substr(0, end), end - bytes);
    if (c.valid && c.bytes == bytes) return c;
  }
  return {kReplacement, 1, false};
}

void AppendUtf8(char32_t value, std::string* to) {
  const auto byte = [to](char32_t b) { to->push_back(static_cast<char>(b)); };
  if (value < 0x80) {
    byte(value);
  } else if (value < 0x800) {
    byte(0xC0 | value >> 6);
    byte(0x80 | (value & 0x3F));
  } else {
    if (value < 0x10000) {
      byte(0xE0 | value >> 12);
    } else {
      byte(0xF0 | value >> 18);
      byte(0x80 | (value >> 12 & 0x3F));
    }
    byte(0x80 | (value >> 6 & 0x3F));
    byte(0x80 | (value & 0x3F));
  }
}

bool IsSpace(char32_t value) { return In(kSpaces, value); }

bool IsPunctuation(char32_t value) {
  if (value >= 0x80) return In(kPunctuation, value);
  constexpr std::string_view kAscii = "!\"'(),-./:;<>?[\\]^_`{|}~";
  return kAscii.find(static_cast<char>(value)) != std::string_view::npos;
}

bool IsIdeograph(char32_t value) { return In(kIdeographs, value); }

std::size_t CountCharacters(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); at += DecodeAt(text, at).bytes) ++count;
  return count;
}

std::string_view TrimSpace(std::string_view text) {
  while (!text.empty()) {
    const Character c = DecodeAt(text, 0);
    if (!IsSpace(c.value)) break;
    text.remove_prefix(c.bytes);
  }
  while (!text.empty()) {
    const Character c = DecodeBefore(text, text.size());
    if (!IsSpace(c.value)) break;
    text.remove_suffix(c.bytes);
  }
  return text;
}

bool IsOnlyPunctuation(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = DecodeAt(text, at);
    if (!IsPunctuation(c.value) && !IsSpace(c.value)) return false;
    at += c.bytes;
  }
  return true;
}

std::vector<std::string_view> SplitAtSpace(std::string_view text, std::size_t max_parts) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < text.size() && parts.size() < max_parts;) {
    const Character c = DecodeAt(text, at);
    if (IsSpace(c.value)) {
      if (at > begin) parts.push_back(text.substr(begin, at - begin));
      begin = at + c.bytes;
    }
    at += c.bytes;
  }
  if (begin < text.size() && parts.size() < max_parts) parts.push_back(text.substr(begin));
  return parts;
}

std::string LowerAscii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string RepairUtf8(std::string_view text, std::size_t* replaced) {
  std::string repaired;
  repaired.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Character c = DecodeAt(text, at);
    if (c.valid) {
      repaired += text.substr(at, c.bytes);
    } else {
      AppendUtf8(kReplacement, &repaired);
      ++*replaced;
    }
    at += c.bytes;
  }
  return repaired;
}

Result<std::string> ToUtf8(std::string_view bytes) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") return std::string(bytes.substr(3));
  const std::string_view mark = bytes.substr(0, 2);
  if (mark != "\xFF\xFE" && mark != "\xFE\xFF") return std::string(bytes);
  if (bytes.size() % 2 != 0) {
    return Status(Code::kBadInput, "is UTF-16 of " + std::to_string(bytes.size()) +
                                       " bytes, expected an even number");
  }
  return FromUtf16(bytes.substr(2), mark == "\xFE\xFF");
}

}  // namespace gestus::words
