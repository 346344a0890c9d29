// Unicode by libutf8proc, and the few properties it does not have.
#include "models/text/unicode.h"

#include <utf8proc.h>

#include <algorithm>
#include <iterator>

namespace gestus::models {
namespace {

bool Within(std::int32_t value, std::int32_t first, std::int32_t last) {
  return first <= value && value <= last;
}

// The blocks that the published tokeniser lists.  Kana and Hangul are not among them.
bool IsIdeograph(std::int32_t c) {
  return Within(c, 0x4E00, 0x9FFF) || Within(c, 0x3400, 0x4DBF) || Within(c, 0x20000, 0x2A6DF) ||
         Within(c, 0x2A700, 0x2B73F) || Within(c, 0x2B740, 0x2B81F) ||
         Within(c, 0x2B820, 0x2CEAF) || Within(c, 0xF900, 0xFAFF) || Within(c, 0x2F800, 0x2FA1F);
}

bool IsAsciiSign(std::int32_t c) {
  return Within(c, 33, 47) || Within(c, 58, 64) || Within(c, 91, 96) || Within(c, 123, 126);
}

// Word_Break = MidLetter, MidNumLet or Single_Quote (UAX #29).
constexpr std::int32_t kMidWord[] = {0x0027, 0x002E, 0x003A, 0x00B7, 0x0387, 0x055F,
                                     0x05F4, 0x2018, 0x2019, 0x2024, 0x2027, 0xFE13,
                                     0xFE52, 0xFE55, 0xFF07, 0xFF0E, 0xFF1A};

bool IsMidWord(std::int32_t c) {
  return std::find(std::begin(kMidWord), std::end(kMidWord), c) != std::end(kMidWord);
}

// Other_Lowercase and Other_Uppercase, less the characters that are case-ignorable as well.
bool IsCasedThoughNoLetter(std::int32_t c) {
  return c == 0xAA || c == 0xBA || Within(c, 0x2160, 0x217F) || Within(c, 0x24B6, 0x24E9) ||
         Within(c, 0x1F130, 0x1F149) || Within(c, 0x1F150, 0x1F169) || Within(c, 0x1F170, 0x1F189);
}

}  // namespace

Decoded DecodeUtf8(std::string_view text, std::size_t at) {
  std::int32_t value = 0;
  const auto bytes = utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()) + at,
                                      static_cast<utf8proc_ssize_t>(text.size() - at), &value);
  if (bytes <= 0) return {kReplacement, 1};
  return {value, static_cast<std::size_t>(bytes)};
}

bool IsUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Decoded c = DecodeUtf8(text, at);
    // U+FFFD itself takes three bytes.
    if (c.value == kReplacement && c.bytes == 1) return false;
    at += c.bytes;
  }
  return true;
}

void AppendUtf8(std::int32_t value, std::string* to) {
  utf8proc_uint8_t bytes[4];
  const auto count = utf8proc_encode_char(value, bytes);
  to->append(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(count));
}

Kind KindOf(std::int32_t value) {
  if (value == '\t' || value == '\n' || value == '\r') return Kind::kSpace;
  if (value == kReplacement) return Kind::kDropped;
  if (IsAsciiSign(value)) return Kind::kPunctuation;
  switch (utf8proc_category(value)) {
    case UTF8PROC_CATEGORY_CN:
    case UTF8PROC_CATEGORY_CC:
    case UTF8PROC_CATEGORY_CF:
    case UTF8PROC_CATEGORY_CS:
    case UTF8PROC_CATEGORY_CO:
      return Kind::kDropped;
    case UTF8PROC_CATEGORY_ZS:
    // The published rules name Zs alone, but then split with Python's str.split(), which takes
    // U+2028 and U+2029 for spaces.
    case UTF8PROC_CATEGORY_ZL:
    case UTF8PROC_CATEGORY_ZP:
      return Kind::kSpace;
    case UTF8PROC_CATEGORY_PC:
    case UTF8PROC_CATEGORY_PD:
    case UTF8PROC_CATEGORY_PS:
    case UTF8PROC_CATEGORY_PE:
    case UTF8PROC_CATEGORY_PI:
    case UTF8PROC_CATEGORY_PF:
    case UTF8PROC_CATEGORY_PO:
      return Kind::kPunctuation;
    default:
      return IsIdeograph(value) ? Kind::kIdeograph : Kind::kOther;
  }
}

CaseRole CaseRoleOf(std::int32_t value) {
  if (IsMidWord(value)) return CaseRole::kIgnorable;
  switch (utf8proc_category(value)) {
    case UTF8PROC_CATEGORY_MN:
    case UTF8PROC_CATEGORY_ME:
    case UTF8PROC_CATEGORY_CF:
    case UTF8PROC_CATEGORY_LM:
    case UTF8PROC_CATEGORY_SK:
      return CaseRole::kIgnorable;
    case UTF8PROC_CATEGORY_LU:
    case UTF8PROC_CATEGORY_LL:
    case UTF8PROC_CATEGORY_LT:
      return CaseRole::kCased;
    default:
      return IsCasedThoughNoLetter(value) ? CaseRole::kCased : CaseRole::kNone;
  }
}

std::int32_t Lower(std::int32_t value) { return utf8proc_tolower(value); }

Decomposition Decompose(std::int32_t value) {
  Decomposition result{};
  int boundary = 0;
  const auto count = utf8proc_decompose_char(value, result.values.data(),
                                             static_cast<utf8proc_ssize_t>(result.values.size()),
                                             UTF8PROC_DECOMPOSE, &boundary);
  result.count = static_cast<std::size_t>(count);
  return result;
}

bool IsNonspacingMark(std::int32_t value) {
  return utf8proc_category(value) == UTF8PROC_CATEGORY_MN;
}

int CombiningClass(std::int32_t value) { return utf8proc_get_property(value)->combining_class; }

}  // namespace gestus::models
