// The first half of WordPiece (models/text/wordpiece.h, steps 1 to 3): a text as words.
#ifndef GESTUS_MODELS_TEXT_WORDS_H_
#define GESTUS_MODELS_TEXT_WORDS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace gestus::models {

/// A character as it will be looked up, and the bytes [begin, end) of the text that it came from.
struct WordChar {
  std::int32_t value;
  std::size_t begin, end;
};
/// Takes one word, which is never empty and is gone after the call.
using WordSink = std::function<void(const std::vector<WordChar>& word)>;

struct WordRules {
  bool lower_case;  ///< lower case, decompose and drop accents
  /// Of a longer word the sink gets the first max_chars + 1 characters, the last of which covers
  /// the bytes of all the rest: enough to see that it is too long, in bounded memory.
  std::size_t max_chars;
};

/// Gives the words of `text`, any bytes, to `sink` in their order.
void ForEachWord(std::string_view text, const WordRules& rules, const WordSink& sink);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_TEXT_WORDS_H_
