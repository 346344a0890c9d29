// Characters of transcripts: decoding that survives any bytes, and the kinds of characters that a
// reader of words has to tell apart.  A private header of models/words.
#ifndef GESTUS_MODELS_WORDS_UTF8_H_
#define GESTUS_MODELS_WORDS_UTF8_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"

namespace gestus::words {

struct Character {
  char32_t value;     ///< U+FFFD where the bytes are not UTF-8
  std::size_t bytes;  ///< how many it takes, at least 1
  bool valid;
};

/// The character at byte `at` < text.size().
Character DecodeAt(std::string_view text, std::size_t at);
/// The last character of text[0, end), end > 0.
Character DecodeBefore(std::string_view text, std::size_t end);
void AppendUtf8(char32_t value, std::string* to);

bool IsSpace(char32_t value);
/// Signs that stand beside a word without being spoken; "&", "%", "+" and the like are spoken.
bool IsPunctuation(char32_t value);
/// Letters of scripts written without spaces where each is a word or near it: Han and kana.
bool IsIdeograph(char32_t value);

std::size_t CountCharacters(std::string_view text);
/// `text` without white space of any script at its ends.
std::string_view TrimSpace(std::string_view text);
/// Whether nothing in `text` is spoken: white space, punctuation or nothing at all.
bool IsOnlyPunctuation(std::string_view text);
/// The parts of `text` between white space, the first `max_parts` of them.
std::vector<std::string_view> SplitAtSpace(std::string_view text, std::size_t max_parts);
/// `text` in lower case as far as it is ASCII.
std::string LowerAscii(std::string_view text);

/// `text` with U+FFFD for each byte that belongs to no character; their number goes to `replaced`.
std::string RepairUtf8(std::string_view text, std::size_t* replaced);
/// A file as UTF-8: its byte order mark is taken off, and UTF-16 that has one is converted.
Result<std::string> ToUtf8(std::string_view bytes);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_UTF8_H_
