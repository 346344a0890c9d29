// The text of one line of a subtitle: tags and entities taken out, the times within it kept.  A
// private header of models/words.
#ifndef GESTUS_MODELS_WORDS_CUE_TEXT_H_
#define GESTUS_MODELS_WORDS_CUE_TEXT_H_

#include <string>
#include <string_view>
#include <vector>

#include "models/words/times.h"

namespace gestus::words {

struct CuePart {
  double start = kNoTime;  ///< seconds, where the line gives a time ("<00:00:01.000>")
  std::string text;
};

/// The parts of a line, at least one.  "<i>", "<v Anna>", "<c.red>", "{\an8}" and the signs of
/// songs are left out; "&amp;" and its like become the characters that they stand for.
std::vector<CuePart> ParseCueLine(std::string_view line);

/// The text of all parts, without blanks at its ends.
std::string PlainText(const std::vector<CuePart>& parts);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_CUE_TEXT_H_
