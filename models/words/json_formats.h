// The JSON of one recogniser or aligner each, and what their readers share.  A private header of
// models/words: only its .cc files see the JSON library.
#ifndef GESTUS_MODELS_WORDS_JSON_FORMATS_H_
#define GESTUS_MODELS_WORDS_JSON_FORMATS_H_

#include <initializer_list>
#include <string>
#include <string_view>

#include "engine/status.h"
#include "models/io/json_reader.h"
#include "models/words/draft.h"

namespace gestus::words {

/// The member `name` when it is an array; else null.
const Json* ArrayMember(const Json& object, const char* name);
/// The first of `names` that `object` has and that is not null; else null.
const Json* FirstMember(const Json& object, std::initializer_list<const char*> names);
/// A number of seconds, a string that ParseTime() knows, or {"seconds", "nanos"}; else kNoTime.
double TimeOf(const Json* value);
/// The start and the end (or duration) of `object` under any of the names in use.
Span SpanOf(const Json& object);
/// The string under the first of `names` that is there; `where` ("segments[3]") is for the error.
Result<std::string_view> TextOf(const Json& object, std::initializer_list<const char*> names,
                                const std::string& where);
/// "words[3]"
std::string Element(const std::string& array, std::size_t index);

/// Finds out which pieces begin a word when leading blanks tell, as in the tokens and words of
/// Whisper.  In a file without such blanks every piece begins one.
class Spacing {
 public:
  void Count(std::string_view piece);
  bool spaced() const { return blanks_ > 0 && blanks_ * 8 >= pieces_; }
  /// Whether `piece` continues the word of the piece before it.
  bool Continues(std::string_view piece) const;

 private:
  std::size_t pieces_ = 0, blanks_ = 0;
};

bool IsWhisperCpp(const Json& root);
Status ReadWhisperCpp(const Json& root, Draft* draft);

/// openai-whisper, faster-whisper, WhisperX: segments that hold words.
bool IsSegments(const Json& root);
Status ReadSegments(const Json& root, Draft* draft);

bool IsGoogle(const Json& root);
Status ReadGoogle(const Json& root, Draft* draft);

bool IsGentle(const Json& root);
Status ReadGentle(const Json& root, Draft* draft);

/// The Montreal Forced Aligner's JSON.
bool IsTiers(const Json& root);
Status ReadTiers(const Json& root, Draft* draft);

/// A plain list of words, as Vosk and OpenAI's service give it.
bool IsWordList(const Json& root);
Status ReadWordList(const Json& root, Draft* draft);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_JSON_FORMATS_H_
