#include "models/words/transcript.h"

#include <utility>

#include "models/io/reading.h"
#include "models/words/formats.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

struct Format {
  bool (*looks)(std::string_view);
  Result<Draft> (*read)(std::string_view);
};

// The first whose test passes reads the file, so what is stricter comes first.
constexpr Format kFormats[] = {
    {LooksLikeJson, ReadJson},           {LooksLikeTextGrid, ReadTextGrid},
    {LooksLikeSubtitles, ReadSubtitles}, {LooksLikeCtm, ReadCtm},
    {LooksLikeLines, ReadLines},         {LooksLikeCsv, ReadCsv}};

const Format* FindFormat(std::string_view text) {
  for (const Format& format : kFormats) {
    if (format.looks(text)) return &format;
  }
  return nullptr;
}

Result<Transcript> Parse(std::string_view bytes, const TranscriptOptions& options) {
  if (bytes.size() > kMaxTranscriptBytes) {
    return Status(Code::kBadInput, "has more than 64 MiB, expected a transcript");
  }
  Result<std::string> text = ToUtf8(bytes);
  if (!text.ok()) return text.status();
  if (TrimSpace(*text).empty()) return Transcript{{}, "empty file", {"the file is empty"}};
  if (const Format* format = FindFormat(*text); format != nullptr) {
    Result<Draft> draft = format->read(*text);
    if (!draft.ok()) return draft.status();
    return std::move(*draft).Finish();
  }
  if (options.plain_text && LooksLikePlainText(*text)) return ReadPlainText(*text);
  return Status(Code::kBadInput,
                "holds no words with times in a form that gestus knows, expected the JSON of a "
                "speech recogniser, TextGrid, WebVTT, SRT, CTM, CSV, or lines of start, end and "
                "word");
}

}  // namespace

Result<Transcript> ReadTranscript(const std::string& path, const TranscriptOptions& options) {
  Result<std::string> bytes = ReadFile(path, kMaxTranscriptBytes);
  if (!bytes.ok()) return bytes.status();
  return ParseTranscript(*bytes, path, options);
}

Result<Transcript> ParseTranscript(std::string_view bytes, const std::string& name,
                                   const TranscriptOptions& options) {
  Result<Transcript> transcript = Parse(bytes, options);
  if (!transcript.ok()) return transcript.status().In(name);
  return transcript;
}

bool LooksTimed(std::string_view head) {
  const Result<std::string> text = ToUtf8(head);
  return text.ok() && !TrimSpace(*text).empty() && FindFormat(*text) != nullptr;
}

std::string_view Stripped(std::string_view word) {
  while (!word.empty()) {
    const Character c = DecodeAt(word, 0);
    if (!IsPunctuation(c.value)) break;
    word.remove_prefix(c.bytes);
  }
  while (!word.empty()) {
    const Character c = DecodeBefore(word, word.size());
    if (!IsPunctuation(c.value)) break;
    word.remove_suffix(c.bytes);
  }
  return word;
}

}  // namespace gestus::words
