// The readers behind ParseTranscript(), one per family of formats.  Each has a test that looks at
// the content, and a reader that is given only what passed the test; both take any bytes.  A
// private header of models/words.
#ifndef GESTUS_MODELS_WORDS_FORMATS_H_
#define GESTUS_MODELS_WORDS_FORMATS_H_

#include <string_view>

#include "engine/status.h"
#include "models/words/draft.h"

namespace gestus::words {

/// Recognisers' JSON (json_formats.cc).
bool LooksLikeJson(std::string_view text);
Result<Draft> ReadJson(std::string_view text);

/// Praat's text files (praat.cc).
bool LooksLikeTextGrid(std::string_view text);
Result<Draft> ReadTextGrid(std::string_view text);

/// WebVTT, SRT, and what whisper.cpp prints (subtitles.cc).
bool LooksLikeSubtitles(std::string_view text);
Result<Draft> ReadSubtitles(std::string_view text);

/// Tables with a separator, with and without a header (csv.cc).
bool LooksLikeCsv(std::string_view text);
Result<Draft> ReadCsv(std::string_view text);

/// CTM, and lines of start, end and word (lines.cc).
bool LooksLikeCtm(std::string_view text);
Result<Draft> ReadCtm(std::string_view text);
bool LooksLikeLines(std::string_view text);
Result<Draft> ReadLines(std::string_view text);

/// Prose in UTF-8 (plain_text.cc); any text that no other reader takes may look like it.
bool LooksLikePlainText(std::string_view text);
Result<Transcript> ReadPlainText(std::string_view text);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_FORMATS_H_
