// WebVTT, SRT, and the lines "[00:00:00.000 --> 00:00:02.000]  text" that whisper.cpp and Whisper
// print: cues with a start, an end and text.  Speech is seldom timed by word here, so most words
// get their share of the cue.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/words/cue_text.h"
#include "models/words/formats.h"
#include "models/words/text_lines.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

constexpr std::string_view kArrow = "-->";
// Captions that roll repeat lines all the time; subtitles do so by chance.
constexpr std::size_t kFewRepetitions = 3;

struct Line {
  std::vector<CuePart> parts;
  std::string plain;  // for comparison
};

struct Cue {
  Span span;
  std::vector<Line> lines;
};

// The times of "00:00:01.000 --> 00:00:02.000 align:start"; in brackets, with text behind, as
// printed by Whisper.
struct Timing {
  Span span;
  bool bracketed;
  std::string_view rest;
};

std::optional<Timing> ParseTiming(std::string_view line) {
  const std::size_t arrow = line.find(kArrow);
  if (arrow == std::string_view::npos) return std::nullopt;
  std::string_view left = Trim(line.substr(0, arrow));
  std::string_view right = Trim(line.substr(arrow + kArrow.size()));
  Timing timing{{}, left.starts_with('['), {}};
  if (timing.bracketed) left.remove_prefix(1);
  const std::size_t end = right.find_first_of(timing.bracketed ? "]" : " \t");
  if (timing.bracketed && end == std::string_view::npos) return std::nullopt;
  if (timing.bracketed) timing.rest = right.substr(end + 1);
  right = right.substr(0, end);
  const bool clocks = left.find(':') != std::string_view::npos;
  const bool ok =
      clocks && ParseTime(left, &timing.span.start) && ParseTime(right, &timing.span.end);
  return ok ? std::optional(timing) : std::nullopt;
}

bool IsWebVtt(std::string_view text) {
  return text.starts_with("WEBVTT") &&
         (text.size() == 6 || std::string_view(" \t\r\n").find(text[6]) != std::string_view::npos);
}

// Whether a line was meant to hold times.
bool IsSpoiltTiming(std::string_view line) {
  line = Trim(line);
  return !line.empty() && line[0] >= '0' && line[0] <= '9' &&
         line.find(kArrow) != std::string_view::npos;
}

bool IsCueNumber(std::string_view line) {
  line = Trim(line);
  return !line.empty() && line.find_first_not_of("0123456789") == std::string_view::npos;
}

// Reads cues line by line.  Lines go to the last cue even behind an empty one: tools leave empty
// lines within cues, and drop the blank in lines that hold nothing else.
class CueReader {
 public:
  explicit CueReader(bool vtt) : skipping_(vtt), vtt_(vtt) {}

  Status Read(std::string_view text) {
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::string_view line = TakeLine(&text);
      const std::optional<Timing> timing = ParseTiming(line);
      if (timing) {
        BeginCue(*timing);
      } else if (!skipping_ && IsSpoiltTiming(line)) {
        return BadLine(number, line, "times as in 00:00:01.000 --> 00:00:02.000");
      } else {
        AddLine(line);
      }
    }
    Flush();
    return Status();
  }

  std::vector<Cue> Finish() { return std::move(cues_); }

 private:
  void BeginCue(const Timing& timing) {
    // The line right before may be the cue's number or name.
    if (pending_ && !pending_after_blank_ && !IsCueNumber(*pending_)) Flush();
    pending_.reset();
    cues_.push_back({timing.span, {}});
    skipping_ = false;
    after_blank_ = false;
    if (timing.bracketed) pending_ = timing.rest;
    Flush();
  }

  void AddLine(std::string_view line) {
    Flush();
    const bool blank = line.empty();
    const bool begins_block =
        vtt_ && after_blank_ && (line.starts_with("NOTE") || line == "STYLE" || line == "REGION");
    if (begins_block) skipping_ = true;
    if (blank) skipping_ = false;
    if (!blank && !skipping_) {
      pending_ = line;
      pending_after_blank_ = after_blank_;
    }
    after_blank_ = blank;
  }

  // Gives the line that waits to the last cue; before the first there is no text.
  void Flush() {
    if (pending_ && !cues_.empty()) {
      Line line{ParseCueLine(*pending_), {}};
      line.plain = PlainText(line.parts);
      if (!line.plain.empty()) cues_.back().lines.push_back(std::move(line));
    }
    pending_.reset();
  }

  std::vector<Cue> cues_;
  std::optional<std::string_view> pending_;  // the last line, until the next shows what it is
  bool pending_after_blank_ = false;
  bool after_blank_ = true;
  bool skipping_;  // within the header, a note or a style sheet
  bool vtt_;
};

bool HasTimes(const Cue& cue) {
  for (const Line& line : cue.lines) {
    if (line.parts.size() > 1) return true;
  }
  return false;
}

// Captions that roll up, as YouTube makes them, show each line again above the next one, and by
// itself in between.  Leaves each line where it first appears.
void DropRepetitions(std::vector<Cue>* cues, Draft* draft) {
  std::vector<std::size_t> repeating;  // cues whose first line is the last of what was shown
  const std::string* shown = nullptr;
  bool timed = false;
  std::size_t with_text = 0;
  for (std::size_t i = 0; i < cues->size(); ++i) {
    const Cue& cue = (*cues)[i];
    if (cue.lines.empty()) continue;
    ++with_text;
    timed |= HasTimes(cue);
    // A line that is timed by word is said, even when its words were said just before.
    const Line& first = cue.lines.front();
    if (shown != nullptr && first.plain == *shown && first.parts.size() == 1) {
      repeating.push_back(i);
    }
    shown = &cue.lines.back().plain;
  }
  const bool often = repeating.size() >= kFewRepetitions && repeating.size() * 2 >= with_text;
  if (repeating.empty() || (!timed && !often)) return;
  for (const std::size_t i : repeating) {
    std::vector<Line>& lines = (*cues)[i].lines;
    lines.erase(lines.begin());
  }
  draft->AddNote("the captions roll; " + Count(repeating.size(), "line") + " shown again left out");
}

// The text of a cue from one time within it to the next.
struct Stretch {
  double start;
  std::string text;
};

std::vector<Stretch> StretchesOf(const Cue& cue) {
  std::vector<Stretch> stretches = {{cue.span.start, {}}};
  for (const Line& line : cue.lines) {
    stretches.back().text += ' ';
    for (const CuePart& part : line.parts) {
      if (!std::isnan(part.start)) {
        // Times that leave the cue or go back are taken for the nearest that do not.
        const double before = stretches.back().start;
        const double time = std::max(before, std::min(part.start, cue.span.end));
        stretches.push_back({time, {}});
      }
      stretches.back().text += part.text;
    }
  }
  std::erase_if(stretches, [](const Stretch& s) { return TrimSpace(s.text).empty(); });
  return stretches;
}

void AddWords(const Cue& cue, Draft* draft) {
  const std::vector<Stretch> stretches = StretchesOf(cue);
  bool blank = true;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const std::string& text = stretches[i].text;
    const double end = i + 1 < stretches.size() ? stretches[i + 1].start : cue.span.end;
    const char32_t first = DecodeAt(text, 0).value;
    // "gram<00:01.000>mar" is one word in two parts.
    const bool joins = !blank && !IsSpace(first) && !IsIdeograph(first);
    draft->Add(text, {stretches[i].start, end}, joins);
    blank = IsSpace(DecodeBefore(text, text.size()).value);
  }
}

// By start; a cue that the next one cuts off ends there, so that its words do not mix with those of
// the next.
void SortAndCut(std::vector<Cue>* cues, Draft* draft) {
  std::stable_sort(cues->begin(), cues->end(),
                   [](const Cue& a, const Cue& b) { return a.span.start < b.span.start; });
  std::size_t cut = 0;
  for (std::size_t i = 0; i + 1 < cues->size(); ++i) {
    Span& span = (*cues)[i].span;
    const double next = (*cues)[i + 1].span.start;
    if (span.end <= next || next <= span.start) continue;
    span.end = next;
    ++cut;
  }
  if (cut > 0) draft->AddNote(Count(cut, "cue") + " cut short where the next one begins");
}

}  // namespace

bool LooksLikeSubtitles(std::string_view text) {
  if (IsWebVtt(text)) return true;
  // A byte order mark, numbers or a title may come before the first times.
  constexpr int kLinesToTry = 50;
  for (int i = 0; i < kLinesToTry && !text.empty(); ++i) {
    if (ParseTiming(TakeLine(&text))) return true;
  }
  return false;
}

Result<Draft> ReadSubtitles(std::string_view text) {
  const bool vtt = IsWebVtt(text);
  CueReader reader(vtt);
  GESTUS_RETURN_IF_ERROR(reader.Read(text));
  std::vector<Cue> cues = reader.Finish();
  const bool printed = Trim(text).starts_with('[');
  Draft draft(vtt ? "WebVTT" : printed ? "Whisper's printed lines" : "SRT");
  DropRepetitions(&cues, &draft);
  // What rolls is empty now, and would only cut others off.
  std::erase_if(cues, [](const Cue& cue) { return cue.lines.empty(); });
  SortAndCut(&cues, &draft);
  for (const Cue& cue : cues) AddWords(cue, &draft);
  return draft;
}

}  // namespace gestus::words
