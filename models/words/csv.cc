// Tables separated by tabs, semicolons, commas or bars: with a header that names the columns, in
// any order; without one, in the orders start-end-word, word-start-end and Gentle's
// word-word-start-end.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/words/formats.h"
#include "models/words/text_lines.h"
#include "models/words/tiers.h"
#include "models/words/utf8.h"

namespace gestus::words {
namespace {

constexpr int kNone = -1;
constexpr std::size_t kMaxColumns = 256;  // what lies beyond is not looked at
constexpr int kRowsToTry = 20;

using Row = std::vector<std::string>;

// Takes a table apart after RFC 4180, row by row.
class RowReader {
 public:
  RowReader(std::string_view text, char separator) : text_(text), separator_(separator) {}

  /// False at the end.  `row` keeps its memory from call to call.
  Result<bool> Next(Row* row) {
    row->clear();
    if (at_ >= text_.size()) return false;
    first_line_ = line_;
    do {
      row->emplace_back();
      GESTUS_RETURN_IF_ERROR(TakeCell(&row->back()));
      if (row->size() > kMaxColumns) row->pop_back();
    } while (TakeSeparator());
    TakeLineEnd();
    return true;
  }
  std::size_t line() const { return first_line_; }  ///< where the last row begins

 private:
  bool AtEnd() const { return at_ >= text_.size() || text_[at_] == '\n' || text_[at_] == '\r'; }

  bool TakeSeparator() {
    if (AtEnd() || text_[at_] != separator_) return false;
    ++at_;
    return true;
  }

  void TakeLineEnd() {
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ < text_.size() && text_[at_] == '\n') ++at_;
    ++line_;
  }

  Status TakeCell(std::string* cell) {
    if (separator_ != '\t') {
      while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    }
    if (at_ < text_.size() && text_[at_] == '"') GESTUS_RETURN_IF_ERROR(TakeQuoted(cell));
    while (!AtEnd() && text_[at_] != separator_) *cell += text_[at_++];
    return Status();
  }

  // Tables with tabs (Whisper's) are often written without quoting, so there a quotation mark with
  // no second one on its line is text.
  Status TakeQuoted(std::string* cell) {
    const bool within_line = separator_ == '\t';
    std::size_t lines = 0;
    for (std::size_t at = at_ + 1; at < text_.size(); ++at) {
      const char c = text_[at];
      if (c == '\n' && within_line) break;
      lines += c == '\n' ? 1 : 0;
      if (c != '"') {
        *cell += c;
        continue;
      }
      if (at + 1 == text_.size() || text_[at + 1] != '"') {
        at_ = at + 1;
        line_ += lines;
        return Status();
      }
      *cell += text_[++at];
    }
    cell->clear();
    if (within_line) return Status();
    return BadLine(first_line_, text_.substr(at_), "a second quotation mark");
  }

  std::string_view text_;
  char separator_;
  std::size_t at_ = 0, line_ = 1, first_line_ = 1;
};

struct Columns {
  int word = kNone, start = kNone, end = kNone, duration = kNone, tier = kNone;
  bool header = false;
  bool milliseconds = false;
  char separator = ',';
};

bool IsOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The letters and digits of a column's name without its unit.
std::string PlainName(std::string_view cell, bool* milliseconds) {
  std::string name;
  for (const char c : LowerAscii(cell)) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) name += c;
  }
  *milliseconds = false;
  for (const std::string_view unit :
       {"milliseconds", "msec", "ms", "seconds", "secs", "sec", "s"}) {
    if (name.size() <= unit.size() || !name.ends_with(unit) || name == "words") continue;
    *milliseconds = unit[0] == 'm';
    name.resize(name.size() - unit.size());
    break;
  }
  return name;
}

// The columns that a first row names; none when it is no header.
std::optional<Columns> FromHeader(const Row& row) {
  Columns columns;
  columns.header = true;
  for (int i = 0; i < static_cast<int>(row.size()); ++i) {
    bool milliseconds = false;
    const std::string name = PlainName(row[static_cast<std::size_t>(i)], &milliseconds);
    int* column = nullptr;
    if (IsOneOf(name, {"word", "words", "text", "token", "label", "transcript", "transcription",
                       "utterance", "value", "content", "annotation", "phrase", "sentence"})) {
      column = &columns.word;
    } else if (IsOneOf(name, {"start", "starttime", "begin", "begintime", "from", "tmin", "xmin",
                              "onset", "timestart", "t0"})) {
      column = &columns.start;
      columns.milliseconds |= milliseconds;
    } else if (IsOneOf(name, {"end", "endtime", "stop", "stoptime", "to", "tmax", "xmax", "offset",
                              "timeend", "finish", "t1"})) {
      column = &columns.end;
    } else if (IsOneOf(name, {"duration", "dur", "length"})) {
      column = &columns.duration;
    } else if (IsOneOf(name, {"type", "tier", "tiername"})) {
      column = &columns.tier;
    }
    if (column != nullptr && *column == kNone) *column = i;
  }
  const bool complete = columns.word != kNone && columns.start != kNone;
  return complete ? std::optional(columns) : std::nullopt;
}

std::string_view Cell(const Row& row, int column) {
  const auto i = static_cast<std::size_t>(column);
  return column == kNone || i >= row.size() ? std::string_view() : std::string_view(row[i]);
}

// Whether a cell holds a time or says that there is none; that is kNoTime.
bool ParseCell(std::string_view cell, double* time) {
  *time = kNoTime;
  return IsNoTime(cell) || ParseTime(cell, time);
}

// Whether the first rows have times where `columns` says so.
bool Fit(std::string_view text, const Columns& columns) {
  RowReader reader(text, columns.separator);
  Row row;
  int rows = 0, timed = 0;
  while (rows < kRowsToTry) {
    const Result<bool> more = reader.Next(&row);
    if (!more.ok()) return false;
    if (!*more) break;
    if (row.size() == 1 && Trim(row[0]).empty()) continue;
    ++rows;
    Span span;
    const auto last = static_cast<std::size_t>(std::max(columns.end, columns.word));
    if (row.size() <= last || !ParseCell(Cell(row, columns.start), &span.start) ||
        !ParseCell(Cell(row, columns.end), &span.end) || span.end < span.start) {
      return false;
    }
    timed += span.start <= span.end ? 1 : 0;
  }
  return timed > 0;
}

std::optional<Columns> FindColumns(std::string_view text) {
  constexpr std::string_view kSeparators = "\t;,|";
  for (const char separator : kSeparators) {
    Row row;
    const Result<bool> more = RowReader(text, separator).Next(&row);
    if (!more.ok() || !*more || row.size() < 2) continue;
    if (std::optional<Columns> columns = FromHeader(row)) {
      columns->separator = separator;
      return columns;
    }
  }
  for (const char separator : kSeparators) {
    for (const auto& [start, end, word] : {std::array{0, 1, 2}, {1, 2, 0}, {2, 3, 0}}) {
      const Columns columns{.word = word, .start = start, .end = end, .separator = separator};
      if (Fit(text, columns)) return columns;
    }
  }
  return std::nullopt;
}

// The time in one cell of a row.
Status TakeTime(const Row& row, int column, const char* what, std::size_t line, double* time) {
  const std::string_view cell = Cell(row, column);
  if (ParseCell(cell, time)) return Status();
  return BadLine(line, cell, std::string("a time, the ") + what + " of a word");
}

Status AddRow(const Row& row, const Columns& columns, std::size_t line, Draft* draft) {
  const std::string tier = LowerAscii(Trim(Cell(row, columns.tier)));
  // The Montreal Forced Aligner lists the phones below the words.
  if (tier == "phones" || tier == "phone" || tier.ends_with(" - phones")) return Status();
  const std::string_view text = Cell(row, columns.word);
  if (IsSilenceLabel(text)) return Status();
  Span span;
  double duration = 0;
  GESTUS_RETURN_IF_ERROR(TakeTime(row, columns.start, "start", line, &span.start));
  GESTUS_RETURN_IF_ERROR(TakeTime(row, columns.end, "end", line, &span.end));
  GESTUS_RETURN_IF_ERROR(TakeTime(row, columns.duration, "duration", line, &duration));
  if (columns.end == kNone) span.end = span.start + duration;
  if (columns.milliseconds) span = {span.start / 1000, span.end / 1000};
  draft->Add(text, span);
  return Status();
}

}  // namespace

bool LooksLikeCsv(std::string_view text) { return FindColumns(text).has_value(); }

Result<Draft> ReadCsv(std::string_view text) {
  const Columns columns = *FindColumns(text);
  Draft draft(columns.separator == '\t' ? "table with tabs" : "CSV");
  RowReader reader(text, columns.separator);
  Row row;
  bool header = columns.header;
  while (true) {
    const Result<bool> more = reader.Next(&row);
    if (!more.ok()) return more.status();
    if (!*more) break;
    const bool empty = row.size() == 1 && Trim(row[0]).empty();
    if (!header && !empty) GESTUS_RETURN_IF_ERROR(AddRow(row, columns, reader.line(), &draft));
    header = false;
  }
  if (!columns.milliseconds) draft.GuessUnit();
  return draft;
}

}  // namespace gestus::words
