// The times of a draft: checked, filled where they are missing, put in order.
#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/words/draft.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// No recording is longer (115 days); a file that says so is in another unit.
constexpr double kMaxSeconds = 1e7;
// Overlaps that are only rounding.
constexpr double kRounding = 1e-3;
// Characters a second.  Nobody speaks as slowly as milliseconds look when taken for seconds.
constexpr double kSlowestSpeech = 0.5;
// What a character of speech takes where a file tells nothing better, and what it may tell.
constexpr double kUsualRate = 0.07, kLeastRate = 0.02, kMostRate = 0.3;

bool Known(double time) { return !std::isnan(time); }

// The later and the earlier of two times of which either may be unknown.
double Later(double a, double b) { return !Known(a) || b > a ? b : a; }
double Earlier(double a, double b) { return !Known(a) || b < a ? b : a; }

// Counts cases and remembers where the first was.
struct Cases {
  std::size_t count = 0;
  double first = 0;

  void Add(double time) {
    if (count++ == 0) first = time;
  }
  std::string Text(const std::string& one, const std::string& many) const {
    return Count(count, "word") + " " + (count == 1 ? one : many) + ", the first at " +
           Fixed(first, 2) + " s; ";
  }
};

}  // namespace

void Draft::NoteUnit(std::string_view text, Span span) {
  for (const double time : {span.start, span.end}) {
    if (Known(time) && time != std::floor(time)) whole_times_ = false;
  }
  if (!(span.end > span.start)) return;
  phrase_seconds_ += span.end - span.start;
  phrase_characters_ += static_cast<double>(CountCharacters(text));
}

void Draft::GuessUnit() {
  if (!whole_times_ || phrase_seconds_ == 0) return;
  if (phrase_characters_ / phrase_seconds_ > kSlowestSpeech) return;
  for (Entry& word : words_) word.span = {word.span.start / 1000, word.span.end / 1000};
  AddNote("the times are whole numbers and were taken for milliseconds");
}

Status Draft::CheckTimes() {
  Cases negative, reversed;
  for (Span& span : segments_) {
    // These only bound words that have no times.
    if (!(std::fabs(span.start) <= kMaxSeconds)) span.start = kNoTime;
    if (!(std::fabs(span.end) <= kMaxSeconds) || span.end < span.start) span.end = kNoTime;
    if (span.start < 0) span.start = 0;
    if (span.end < 0) span.end = 0;
  }
  for (std::size_t i = 0; i < words_.size(); ++i) {
    Span& span = words_[i].span;
    for (double* time : {&span.start, &span.end}) {
      if (*time > kMaxSeconds || *time < -kMaxSeconds) {
        return Status(Code::kBadInput, "word " + std::to_string(i + 1) + ": has the time " +
                                           Significant(*time, 6) + " s, expected at most " +
                                           Grouped(static_cast<std::uint64_t>(kMaxSeconds)) + " s");
      }
      if (*time < 0) {
        negative.Add(*time);
        *time = 0;
      }
    }
    if (span.end < span.start) {
      reversed.Add(span.start);
      span.end = kNoTime;
    }
  }
  if (negative.count > 0) {
    AddNote(Count(negative.count, "time") + " before 0 s, the first " + Fixed(negative.first, 2) +
            " s; set to 0 s");
  }
  if (reversed.count > 0) {
    AddNote(reversed.Text("ends before it starts", "end before they start") +
            "the ends were filled in");
  }
  return Status();
}

bool Draft::StartsSegment(std::size_t i) const {
  return i == 0 || words_[i - 1].segment != words_[i].segment;
}

bool Draft::EndsSegment(std::size_t i) const {
  return i + 1 == words_.size() || words_[i + 1].segment != words_[i].segment;
}

double Draft::SecondsPerCharacter() const {
  double seconds = 0, characters = 0;
  for (const Entry& word : words_) {
    if (!(word.span.end > word.span.start)) continue;
    seconds += word.span.end - word.span.start;
    characters += static_cast<double>(CountCharacters(word.text));
  }
  return characters == 0 ? kUsualRate : std::clamp(seconds / characters, kLeastRate, kMostRate);
}

// For each word the first time that the file gives at or after it.
std::vector<double> Draft::NextKnown(double rate) const {
  std::vector<double> next(words_.size() + 1, kNoTime);
  for (std::size_t i = words_.size(); i-- > 0;) {
    const Entry& word = words_[i];
    const double length = rate * static_cast<double>(CountCharacters(word.text));
    next[i] = next[i + 1];
    if (StartsSegment(i) && Known(segments_[word.segment].start)) {
      next[i] = segments_[word.segment].start;
    }
    if (Known(word.span.end)) next[i] = std::max(0.0, word.span.end - length);
    if (Known(word.span.start)) next[i] = word.span.start;
  }
  return next;
}

// Words of which only the start or only the end is known.
void Draft::FillPartial(double rate, const std::vector<double>& next) {
  double before = 0;  // the last end that is known
  for (std::size_t i = 0; i < words_.size(); ++i) {
    Span& span = words_[i].span;
    const double length = rate * static_cast<double>(CountCharacters(words_[i].text));
    if (Known(span.start) != Known(span.end)) {
      words_[i].timed = false;
      if (Known(span.start)) {
        span.end = span.start + length;
        if (next[i + 1] >= span.start) span.end = std::min(span.end, next[i + 1]);
      } else {
        span.start = std::max(0.0, span.end - length);
        if (before <= span.end) span.start = std::max(span.start, before);
      }
    }
    if (Known(span.end)) before = span.end;
  }
}

// Words [first, last), none of which has a time and all of one segment, between the word before
// them and the time `next`.
void Draft::FillRun(std::size_t first, std::size_t last, double next, double rate) {
  const Span segment = segments_[words_[first].segment];
  const double before = first > 0 ? words_[first - 1].span.end : kNoTime;
  std::vector<std::string_view> texts;
  double length = 0;  // what the words would take at the usual pace
  for (std::size_t i = first; i < last; ++i) {
    texts.push_back(words_[i].text);
    length += rate * static_cast<double>(CountCharacters(words_[i].text));
  }
  Span span = {StartsSegment(first) ? Later(before, segment.start) : before,
               EndsSegment(last - 1) ? Earlier(next, segment.end) : next};
  // WhisperX lets a segment begin and end with its first and last word that has a time, so that
  // there is no room for others: look beyond the segment.
  if (span.end - span.start < length / 2 && StartsSegment(first)) {
    span.start = std::max(Known(before) ? before : 0, std::min(span.start, span.end - length));
  }
  if (span.end - span.start < length / 2 && EndsSegment(last - 1)) {
    span.end = Earlier(next, span.start + length);
  }
  if (!Known(span.start)) span.start = Known(span.end) ? std::max(0.0, span.end - length) : 0;
  if (!Known(span.end)) span.end = span.start + length;
  span.end = std::max(span.start, span.end);
  const std::vector<double> ends = ShareByLength(texts, span);
  for (std::size_t i = first; i < last; ++i) {
    words_[i].span = {i == first ? span.start : ends[i - first - 1], ends[i - first]};
    words_[i].timed = false;
  }
}

Status Draft::FillMissing() {
  const double rate = SecondsPerCharacter();
  const std::vector<double> next = NextKnown(rate);
  const auto known = [](const Span& s) { return Known(s.start) || Known(s.end); };
  const bool any =
      std::any_of(words_.begin(), words_.end(), [&](const Entry& w) { return known(w.span); }) ||
      std::any_of(segments_.begin(), segments_.end(), known);
  if (!words_.empty() && !any) {
    return Status(Code::kBadInput, "has " + Count(words_.size(), "word") +
                                       " but no times, expected a start and an end in seconds");
  }
  FillPartial(rate, next);
  for (std::size_t first = 0; first < words_.size();) {
    std::size_t last = first;
    while (last < words_.size() && !Known(words_[last].span.start) &&
           words_[last].segment == words_[first].segment) {
      ++last;
    }
    if (last > first) FillRun(first, last, next[last], rate);
    first = std::max(last, first + 1);
  }
  Cases filled;
  for (const Entry& word : words_) {
    if (!word.timed) filled.Add(word.span.start);
  }
  if (filled.count == 0) return Status();
  if (filled.count == words_.size()) {
    AddNote("no word has a time of its own; those of phrases were shared out by length");
  } else {
    AddNote(filled.Text("has no time of its own", "have no time of their own") +
            "filled in by length");
  }
  return Status();
}

void Draft::SortAndCut() {
  Cases early, overlap;
  for (std::size_t i = 1; i < words_.size(); ++i) {
    if (words_[i].span.start < words_[i - 1].span.start) early.Add(words_[i].span.start);
  }
  if (early.count > 0) {
    std::stable_sort(words_.begin(), words_.end(),
                     [](const Entry& a, const Entry& b) { return a.span.start < b.span.start; });
    AddNote(early.Text("starts before the one in front of it",
                       "start before the ones in front of them") +
            "all were sorted by time");
  }
  for (std::size_t i = 1; i < words_.size(); ++i) {
    Span& span = words_[i - 1].span;
    const double next = words_[i].span.start;
    if (span.end <= next) continue;
    if (span.end > next + kRounding) overlap.Add(span.start);
    span.end = next;
  }
  if (overlap.count > 0) {
    AddNote(overlap.Text("overlaps the next one", "overlap the next ones") + "cut short");
  }
}

}  // namespace gestus::words
