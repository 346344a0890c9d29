// JSON as recognisers really write it, made fit for a strict parser.  A private header of
// models/words.
#ifndef GESTUS_MODELS_WORDS_JSON_TEXT_H_
#define GESTUS_MODELS_WORDS_JSON_TEXT_H_

#include <string>
#include <string_view>

namespace gestus::words {

struct JsonText {
  std::string text;
  bool escaped = false;  ///< some bytes were; RestoreBytes() brings them back
};

/// Three repairs of what real tools write: NaN and Infinity (Python's json) become null; control
/// characters within strings become spaces; bytes of strings that are not UTF-8 become one
/// private-use character each, because whisper.cpp cuts tokens within characters, whose halves make
/// sense again once they are joined.
JsonText RepairJson(std::string_view bytes);

/// `text` with the characters that RepairJson() put in as the bytes they stand for.
std::string RestoreBytes(std::string_view text);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_JSON_TEXT_H_
