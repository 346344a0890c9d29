// Files as the real tools write them, made by hand: one or more of each format, with their quirks.
#ifndef GESTUS_TESTS_WORDS_SAMPLES_H_
#define GESTUS_TESTS_WORDS_SAMPLES_H_

#include <string>
#include <vector>

#include "models/io/text.h"
#include "models/words/transcript.h"

namespace gestus::words {

struct Sample {
  std::string name;
  std::string bytes;
  std::string format;  // expected
  std::string words;   // expected, as Show() prints them
};

/// Every sample of the test files; each holds at least one word.
const std::vector<Sample>& Samples();

/// "deep 0.40-0.80, learning 0.80-1.30*": an asterisk after words without times of their own.
inline std::string Show(const std::vector<Word>& words) {
  std::string text;
  for (const Word& word : words) {
    text += (text.empty() ? "" : ", ") + word.text + " " + Fixed(word.start, 2) + "-" +
            Fixed(word.end, 2) + (word.timed ? "" : "*");
  }
  return text;
}

/// The same of a file's bytes; its error where it has one.
inline std::string ShowBytes(const std::string& bytes) {
  const Result<Transcript> transcript = ParseTranscript(bytes, "t");
  return transcript.ok() ? Show(transcript->words) : transcript.status().message();
}

inline std::string Notes(const std::string& bytes) {
  const Result<Transcript> transcript = ParseTranscript(bytes, "t");
  if (!transcript.ok()) return transcript.status().message();
  std::string text;
  for (const std::string& note : transcript->notes) text += (text.empty() ? "" : " | ") + note;
  return text;
}

}  // namespace gestus::words

#endif  // GESTUS_TESTS_WORDS_SAMPLES_H_
