// What WordPiece asks of Unicode: decoding that survives any bytes, the kinds of characters, and
// lower case as Python has it.  The tables are libutf8proc's, of the Unicode version that it has.
#ifndef GESTUS_MODELS_TEXT_UNICODE_H_
#define GESTUS_MODELS_TEXT_UNICODE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gestus::models {

/// What bytes that are no UTF-8 are read as.
inline constexpr std::int32_t kReplacement = 0xFFFD;

struct Decoded {
  std::int32_t value;  ///< a code point; kReplacement where the bytes are not UTF-8
  std::size_t bytes;   ///< how many it takes, at least 1
};

/// The code point at byte `at` < text.size().
Decoded DecodeUtf8(std::string_view text, std::size_t at);
bool IsUtf8(std::string_view text);
void AppendUtf8(std::int32_t value, std::string* to);

/// How the published tokeniser takes a character.
enum class Kind {
  kDropped,      ///< U+0000, U+FFFD and category C* but for \t, \n and \r
  kSpace,        ///< category Z*, \t, \n, \r: what Python's str.split() splits at
  kIdeograph,    ///< Chinese characters: each is a word
  kPunctuation,  ///< category P* and every ASCII sign that is no letter, digit or space
  kOther
};
Kind KindOf(std::int32_t value);

/// What a character is to a capital sigma near it (Unicode 3.13, Final_Sigma).
enum class CaseRole {
  kNone,
  kCased,
  kIgnorable  ///< looked through; a character that is cased as well counts as this
};
CaseRole CaseRoleOf(std::int32_t value);

/// The simple lower case mapping.
std::int32_t Lower(std::int32_t value);

/// Canonical decomposition (NFD) of one character.
struct Decomposition {
  std::array<std::int32_t, 4> values;  ///< none of Unicode's is longer
  std::size_t count;
};
Decomposition Decompose(std::int32_t value);

bool IsNonspacingMark(std::int32_t value);  ///< category Mn: accents
/// Canonical combining class; 0 for characters that the canonical order does not move.
int CombiningClass(std::int32_t value);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_TEXT_UNICODE_H_
