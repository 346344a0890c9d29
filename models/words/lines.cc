// One word a line: CTM (NIST: recording, channel, start, duration, word, confidence), and lines of
// start, end and word in the two usual orders, Audacity's label tracks among them.
#include <optional>

#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/words/formats.h"
#include "models/words/text_lines.h"
#include "models/words/tiers.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

// How many lines a format is recognised by.
constexpr int kLinesToTry = 20;

// Empty lines and comments; lines of Audacity that give the frequencies of the label before them.
bool IsIgnored(std::string_view line) {
  line = Trim(line);
  return line.empty() || line.starts_with('#') || line.starts_with(";;") || line.starts_with('\\');
}

struct Entry {
  std::string_view text;
  Span span;
};

std::optional<Entry> ParseEntry(std::string_view line) {
  Entry entry;
  std::string_view rest = line;
  const std::string_view first = TakeField(&rest), second = TakeField(&rest);
  if (!ParseTime(second, &entry.span.start)) return std::nullopt;
  if (ParseTime(first, &entry.span.start)) {
    ParseTime(second, &entry.span.end);
    entry.text = rest;
    return entry;
  }
  entry.text = first;
  if (!ParseTime(TakeField(&rest), &entry.span.end)) return std::nullopt;
  return entry;
}

struct CtmEntry {
  std::string_view recording, channel;
  Entry entry;
};

std::optional<CtmEntry> ParseCtmEntry(std::string_view line) {
  CtmEntry ctm;
  ctm.recording = TakeField(&line);
  ctm.channel = TakeField(&line);
  // "deep 0.4 0.8 0.93 0.97" is a word with scores.
  if (ctm.channel.find('.') != std::string_view::npos) return std::nullopt;
  double duration = 0;
  if (!ParseTime(TakeField(&line), &ctm.entry.span.start)) return std::nullopt;
  if (!ParseTime(TakeField(&line), &duration)) return std::nullopt;
  ctm.entry.span.end = ctm.entry.span.start + duration;
  ctm.entry.text = TakeField(&line);
  return ctm.entry.text.empty() ? std::nullopt : std::optional(ctm);
}

}  // namespace

bool LooksLikeCtm(std::string_view text) {
  int lines = 0;
  bool could_be_times = true, differs = false;  // of the first two fields
  while (lines < kLinesToTry && !text.empty()) {
    const std::string_view line = TakeLine(&text);
    if (IsIgnored(line)) continue;
    const auto ctm = ParseCtmEntry(line);
    if (!ctm && lines == 0) return false;
    ++lines;
    if (!ctm) continue;  // the reader will say so
    double start = 0, end = 0;
    could_be_times = could_be_times && ParseTime(ctm->recording, &start) &&
                     ParseTime(ctm->channel, &end) && start <= end;
    differs |= start != end;
  }
  // "0.5 0.9 20 30 40" is rather a start, an end and three words that are numbers.
  return lines > 0 && !(could_be_times && differs);
}

Result<Draft> ReadCtm(std::string_view text) {
  Draft draft("CTM");
  std::string_view recording;
  std::size_t others = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(&text);
    if (IsIgnored(line)) continue;
    const auto ctm = ParseCtmEntry(line);
    if (!ctm) return BadLine(number, line, "recording, channel, start, duration and word");
    if (recording.empty()) recording = ctm->recording;
    if (ctm->recording != recording) {
      ++others;
    } else if (!IsSilenceLabel(ctm->entry.text)) {
      draft.Add(ctm->entry.text, ctm->entry.span);
    }
  }
  if (others > 0) {
    draft.AddNote(Count(others, "line") + " of other recordings than '" + OneLine(recording, 40) +
                  "' left out");
  }
  return draft;
}

bool LooksLikeLines(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = TakeLine(&text);
    if (!IsIgnored(line)) return ParseEntry(line).has_value();
  }
  return false;
}

Result<Draft> ReadLines(std::string_view text) {
  Draft draft("lines of start, end and word");
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(&text);
    if (IsIgnored(line)) continue;
    const auto entry = ParseEntry(line);
    if (!entry) return BadLine(number, line, "start, end and word");
    if (!IsSilenceLabel(entry->text)) draft.Add(entry->text, entry->span);
  }
  draft.GuessUnit();
  return draft;
}

}  // namespace gestus::words
