// Text without any times, as a user of a speech synthesiser has it: words one after another.
#include <algorithm>

#include "models/io/text.h"
#include "models/words/formats.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// Characters a second of unhurried speech, blanks counted.
constexpr double kPace = 15;
// A table that no reader knows is no prose; a text may name some numbers.
constexpr std::size_t kWordsForANumber = 4;

bool IsNumber(std::string_view word) {
  return word.find_first_of("0123456789") != std::string_view::npos &&
         word.find_first_not_of("0123456789.,:;+-") == std::string_view::npos;
}

bool IsControl(char c) {
  const auto value = static_cast<unsigned char>(c);
  return value == 0x7f || (value < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f');
}

}  // namespace

bool LooksLikePlainText(std::string_view text) {
  std::size_t invalid = 0;
  if (std::any_of(text.begin(), text.end(), IsControl) || text.starts_with('<')) return false;
  (void)RepairUtf8(text, &invalid);
  if (invalid > 0) return false;
  std::size_t spoken = 0, numbers = 0;
  for (const std::string_view word : SplitAtSpace(text, text.size())) {
    if (IsOnlyPunctuation(word)) continue;
    ++spoken;
    numbers += IsNumber(word);
  }
  return spoken > 0 && numbers * kWordsForANumber <= spoken;
}

Result<Transcript> ReadPlainText(std::string_view text) {
  Draft draft("plain text");
  const double seconds = static_cast<double>(CountCharacters(TrimSpace(text))) / kPace;
  const std::vector<std::string_view> words = SplitAtSpace(text, text.size());
  const std::vector<double> ends = ShareByLength(words, {0, seconds});
  for (std::size_t i = 0; i < words.size(); ++i)
    draft.Add(words[i], {i == 0 ? 0 : ends[i - 1], ends[i]});
  Result<Transcript> transcript = std::move(draft).Finish();
  if (!transcript.ok()) return transcript;
  transcript->plain_text = true;
  for (Word& word : transcript->words) word.timed = false;
  transcript->notes.push_back(
      "plain text has no times, its words follow one another at 15 characters a second");
  return transcript;
}

void SpreadOver(double seconds, Transcript* transcript) {
  if (!transcript->plain_text || transcript->words.empty()) return;
  const double scale = seconds / transcript->words.back().end;
  for (Word& word : transcript->words) {
    word.start *= scale;
    word.end *= scale;
  }
  transcript->words.back().end = seconds;
  transcript->notes.back() = "plain text has no times, its words are spread over the " +
                             Significant(seconds, 3) + " s of the recording";
}

}  // namespace gestus::words
