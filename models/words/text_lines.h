// Text taken apart by line and by blank.  A private header of models/words.
#ifndef GESTUS_MODELS_WORDS_TEXT_LINES_H_
#define GESTUS_MODELS_WORDS_TEXT_LINES_H_

#include <string>
#include <string_view>

#include "engine/status.h"

namespace gestus::words {

/// Takes the first line off `text`, which is not empty; lines end in LF, CR LF or CR.
std::string_view TakeLine(std::string_view* text);

/// Takes the first part between spaces and tabs off `line`; empty at its end.
std::string_view TakeField(std::string_view* line);

/// "line 7: 'what stands there', expected WHAT"
Status BadLine(std::size_t number, std::string_view line, const std::string& expected);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_TEXT_LINES_H_
