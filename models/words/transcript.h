// Words and their times from the files of speech recognisers, aligners and subtitle tools.
//
//   auto transcript = ReadTranscript("speech.json");
//   if (!transcript.ok()) return transcript.status();
//   for (const Word& word : transcript->words) ...
//
// The format is recognised by the content of a file, never by its name; docs/features/words.md
// lists the formats and what is taken from each.
#ifndef GESTUS_MODELS_WORDS_TRANSCRIPT_H_
#define GESTUS_MODELS_WORDS_TRANSCRIPT_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"

namespace gestus::words {

struct Word {
  std::string text;           ///< valid UTF-8, as spoken or written, punctuation still on it
  double start = 0, end = 0;  ///< seconds, 0 <= start <= end
  bool timed = true;          ///< false: the file gives no time for this very word
};

struct Transcript {
  std::vector<Word> words;         ///< by start; none overlaps the next; may be empty
  std::string format;              ///< "WhisperX JSON"
  std::vector<std::string> notes;  ///< what was odd about the file, one plain line each
  bool plain_text = false;         ///< the file has no times at all; SpreadOver() can give better
};

struct TranscriptOptions {
  /// Whether prose without times is read too: its words follow one another at 15 characters a
  /// second.  Any text may be prose, so this is for files that a user has named as a transcript.
  bool plain_text = false;
};

/// The longest file that is read.
inline constexpr std::uint64_t kMaxTranscriptBytes = std::uint64_t{64} << 20;

/// Errors begin with the path.  An empty file is a transcript without words: recognisers write
/// one when nobody speaks.
Result<Transcript> ReadTranscript(const std::string& path, const TranscriptOptions& options = {});

/// The same from memory; errors begin with `name`.
Result<Transcript> ParseTranscript(std::string_view bytes, const std::string& name,
                                   const TranscriptOptions& options = {});

/// Whether `head`, the first bytes of a file, begins like one of the formats that have times.
bool LooksTimed(std::string_view head);

/// Spreads the words of plain text over `seconds`, more than 0, by their numbers of characters;
/// other transcripts stay as they are.
void SpreadOver(double seconds, Transcript* transcript);

/// `word` without the punctuation at its ends: "(deep)," -> "deep"; empty when it is nothing else.
/// Case is left alone: the tokeniser lowers it with the whole of Unicode's tables (models/text).
std::string_view Stripped(std::string_view word);

}  // namespace gestus::words

#endif  // GESTUS_MODELS_WORDS_TRANSCRIPT_H_
