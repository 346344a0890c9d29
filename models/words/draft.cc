// The texts of a draft; its times are in draft_times.cc.
#include "models/words/draft.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/io/text.h"
#include "models/words/json_text.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// A description in brackets of more words than this is rather a bracket that never closes.
constexpr std::size_t kMaxSoundWords = 12;
// Two weeks of speech without a pause.
constexpr std::size_t kMaxWords = 4'000'000;

bool ClosesSound(std::string_view text) {
  const std::size_t last = text.find_last_not_of(".,;:!?");
  return last != std::string_view::npos && text[last] == ']';
}

// Whether a sign ends or divides a sentence and so belongs to the word before it.
bool DividesSentence(std::string_view text) {
  for (const std::string_view sign :
       {".", ",", "?", "!", ";", ":", "\u2026", "\u3002", "\u3001", "\uFF01", "\uFF0C", "\uFF1F",
        "\u060C", "\u061B", "\u061F", "\u0964"}) {
    if (text.find(sign) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

std::vector<double> ShareByLength(const std::vector<std::string_view>& parts, Span span) {
  // A dash takes no time.
  const auto length = [](std::string_view part) {
    return IsOnlyPunctuation(part) ? 0 : static_cast<double>(CountCharacters(part));
  };
  double total = 0, so_far = 0;
  for (const std::string_view part : parts) total += length(part);
  std::vector<double> ends;
  for (const std::string_view part : parts) {
    so_far += length(part);
    // The last end is free of rounding, so that it does not pass the start of the next phrase.
    const bool done = so_far >= total;
    ends.push_back(done ? span.end : span.start + (span.end - span.start) * (so_far / total));
  }
  return ends;
}

void Draft::BeginSegment(Span span) {
  const auto unknown = [](Span s) { return std::isnan(s.start) && std::isnan(s.end); };
  if (unknown(span) && unknown(segments_.back())) return;
  segments_.push_back(span);
}

void Draft::Append(std::string_view text, Span span, bool timed) {
  words_.push_back({std::string(text), span, timed, segments_.size() - 1});
}

void Draft::Add(std::string_view text, Span span, bool joins) {
  const std::vector<std::string_view> parts = SplitAtSpace(text, kMaxWords + 1);
  too_many_ |= words_.size() + parts.size() > kMaxWords;
  if (too_many_) return;
  NoteUnit(text, span);
  const std::vector<double> ends = ShareByLength(parts, span);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Span part = {i == 0 ? span.start : ends[i - 1], ends[i]};
    if (i > 0 || !joins || words_.empty()) {
      Append(parts[i], part, parts.size() == 1);
      continue;
    }
    Entry& word = words_.back();
    word.text += parts[i];
    // Recognisers give commas a time too, but it is that of a pause.
    if (!IsOnlyPunctuation(parts[i]) && !std::isnan(part.end)) word.span.end = part.end;
  }
}

Result<Transcript> Draft::Finish() && {
  if (too_many_) {
    return Status(Code::kBadInput, "has more words than expected, at most " + Grouped(kMaxWords));
  }
  RepairTexts();
  DropSounds();
  AttachPunctuation();
  GESTUS_RETURN_IF_ERROR(CheckTimes());
  GESTUS_RETURN_IF_ERROR(FillMissing());
  SortAndCut();
  Transcript transcript{{}, std::move(format_), std::move(notes_)};
  transcript.words.reserve(words_.size());
  for (Entry& word : words_) {
    transcript.words.push_back({std::move(word.text), word.span.start, word.span.end, word.timed});
  }
  return transcript;
}

void Draft::RepairTexts() {
  std::size_t replaced = 0;
  for (Entry& word : words_) {
    if (escaped_) word.text = RestoreBytes(word.text);
    const std::size_t before = replaced;
    std::string repaired = RepairUtf8(word.text, &replaced);
    if (replaced > before) word.text = std::move(repaired);
  }
  if (replaced > 0) {
    AddNote(Count(replaced, "byte") + " of the words " + (replaced == 1 ? "is" : "are") +
            " not UTF-8 and became U+FFFD");
  }
}

// "[Music]" and "[BLANK_AUDIO]" are what was heard, not what was said.
void Draft::DropSounds() {
  std::size_t kept = 0, sounds = 0;
  for (std::size_t i = 0; i < words_.size(); ++i) {
    if (words_[i].text.starts_with('[')) {
      const std::size_t limit = std::min(words_.size(), i + kMaxSoundWords);
      std::size_t last = i;
      while (last < limit && !ClosesSound(words_[last].text)) ++last;
      if (last < limit) {
        i = last;
        ++sounds;
        continue;
      }
    }
    if (kept != i) words_[kept] = std::move(words_[i]);
    ++kept;
  }
  words_.erase(words_.begin() + static_cast<std::ptrdiff_t>(kept), words_.end());
  if (sounds > 0) AddNote(Count(sounds, "description") + " in square brackets left out");
}

// A sign with a time of its own goes to the word before it when it tells about the sentence, and is
// dropped when it does not.
void Draft::AttachPunctuation() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < words_.size(); ++i) {
    if (IsOnlyPunctuation(words_[i].text)) {
      if (kept > 0 && DividesSentence(words_[i].text)) words_[kept - 1].text += words_[i].text;
      continue;
    }
    if (kept != i) words_[kept] = std::move(words_[i]);
    ++kept;
  }
  words_.erase(words_.begin() + static_cast<std::ptrdiff_t>(kept), words_.end());
}

}  // namespace gestus::words
