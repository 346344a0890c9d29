#include "models/motion/openface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/motion/lines.h"

namespace gestus::motion {
namespace {

// Cells beyond this are damage, not measurements.
constexpr double kMaxValue = 1e6;
constexpr double kMaxNumber = 1e15;  // of frames and faces; whole numbers stay exact

// The cell before the next comma, which is taken off `line`.
std::string_view TakeCell(std::string_view* line) {
  const std::size_t comma = line->find(',');
  std::string_view cell = Trim(line->substr(0, comma));
  line->remove_prefix(comma == std::string_view::npos ? line->size() : comma + 1);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
    cell = Trim(cell.substr(1, cell.size() - 2));
  }
  return cell;
}

// Splits at every comma, so that "a," has two cells.
void Split(std::string_view line, std::vector<std::string_view>* cells) {
  cells->clear();
  for (bool more = true; more;) {
    more = line.find(',') != std::string_view::npos;
    cells->push_back(TakeCell(&line));
  }
}

// Where the columns stand that are needed.
struct Columns {
  std::size_t count = 0;  // of all
  std::optional<std::size_t> frame, face, timestamp, confidence, success;
  std::vector<std::string> names;   // of the values
  std::vector<std::size_t> values;  // where they stand
};

bool IsMotion(std::string_view name) {
  if (name == "pose_Rx" || name == "pose_Ry" || name == "pose_Rz") return true;
  const auto digit = [&](std::size_t i) { return name[i] >= '0' && name[i] <= '9'; };
  return name.size() == 6 && name.starts_with("AU") && digit(2) && digit(3) && name.ends_with("_r");
}

std::string Quoted(std::string_view text) { return "\"" + OneLine(text, 40) + "\""; }

Result<Columns> FindColumns(std::string_view header, const std::vector<std::string>& wanted) {
  if (header.starts_with("\xef\xbb\xbf")) header.remove_prefix(3);
  std::vector<std::string_view> names;
  Split(header, &names);
  std::map<std::string_view, std::size_t> places;
  Columns columns;
  columns.count = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!places.emplace(names[i], i).second && !names[i].empty()) {
      return BadInput("line 1: column " + Quoted(names[i]) + " is there twice, expected once");
    }
    if (wanted.empty() && IsMotion(names[i])) columns.names.emplace_back(names[i]);
  }
  const auto place = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto found = places.find(name);
    return found == places.end() ? std::nullopt : std::optional(found->second);
  };
  if (!wanted.empty()) columns.names = wanted;
  for (const std::string& name : columns.names) {
    if (!place(name))
      return BadInput("has no column " + Quoted(name) + ", expected it of OpenFace");
    columns.values.push_back(*place(name));
  }
  if (columns.values.empty()) {
    return BadInput("line 1: has no columns like AU01_r or pose_Rx, expected OpenFace's header");
  }
  columns.frame = place("frame");
  columns.face = place("face_id");
  columns.timestamp = place("timestamp");
  columns.confidence = place("confidence");
  columns.success = place("success");
  return columns;
}

// A line without its values.
struct Row {
  std::int64_t frame = 0, face = 0;
  float confidence = 0;
};

struct Table {
  std::vector<Row> rows;
  std::vector<float> values;  // (rows, columns); NaN where a cell is none
  double first_time = 0, last_time = 0;
  std::int64_t first_timed = -1, last_timed = -1;  // frames of these times
  std::int64_t no_numbers = 0;
};

// What programs write for a number that there is not.
bool IsNoNumber(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  for (const char* name : {"", "nan", "NaN", "NAN", "nan(ind)", "inf", "Inf", "INF"}) {
    if (cell == name) return true;
  }
  return false;
}

// One line after the other into a Table.
class TableReader {
 public:
  TableReader(const Columns& columns, std::int64_t max_rows)
      : columns_(columns), max_rows_(max_rows) {}

  Status Add(std::string_view line, std::int64_t number, Table* table) {
    Split(line, &cells_);
    const std::string where = "line " + std::to_string(number);
    if (cells_.size() != columns_.count) {
      return BadInput(where + ": has " + Count(cells_.size(), "cell") + ", but the header has " +
                      std::to_string(columns_.count));
    }
    if (std::ssize(table->rows) == max_rows_) {
      return Status(
          Code::kResourceExhausted,
          where + ": expected at most " + Count(static_cast<std::uint64_t>(max_rows_), "row"));
    }
    Row row;
    GESTUS_RETURN_IF_ERROR(AddKeys(table, &row).In(where));
    for (std::size_t i = 0; i < columns_.values.size(); ++i) {
      const std::string_view cell = cells_[columns_.values[i]];
      double value = std::nan("");
      if (IsNoNumber(cell)) {
        ++table->no_numbers;
      } else if (!ParseNumber(cell, &value) || std::fabs(value) > kMaxValue) {
        return NoNumber(columns_.names[i], cell, "a number within 1000000 of 0").In(where);
      }
      table->values.push_back(static_cast<float>(value));
    }
    table->rows.push_back(row);
    return Status();
  }

 private:
  static Status NoNumber(const std::string& column, std::string_view cell,
                         const std::string& expected) {
    return BadInput("column " + Quoted(column) + ": " + Quoted(cell) + ", expected " + expected);
  }

  // A whole number, `value` as it is where there is no such column.
  Status Whole(const std::optional<std::size_t>& column, const std::string& name,
               std::int64_t* value) const {
    if (!column) return Status();
    double number = 0;
    if (!ParseNumber(cells_[*column], &number) || number != std::floor(number) || number < 0 ||
        number > kMaxNumber) {
      return NoNumber(name, cells_[*column], "a whole number");
    }
    *value = static_cast<std::int64_t>(number);
    return Status();
  }

  Status AddKeys(Table* table, Row* row) const {
    row->frame = std::ssize(table->rows);
    GESTUS_RETURN_IF_ERROR(Whole(columns_.frame, "frame", &row->frame));
    GESTUS_RETURN_IF_ERROR(Whole(columns_.face, "face_id", &row->face));
    if (!table->rows.empty() && row->frame < table->rows.back().frame) {
      return BadInput("frame " + std::to_string(row->frame) + " follows frame " +
                      std::to_string(table->rows.back().frame) + ", expected ascending numbers");
    }
    double confidence = 1, success = 1, time = 0;
    if (columns_.confidence && !ParseNumber(cells_[*columns_.confidence], &confidence)) {
      confidence = 0;  // older versions write "-nan(ind)" where nothing was found
    }
    if (columns_.success && !ParseNumber(cells_[*columns_.success], &success)) success = 0;
    row->confidence = success > 0 ? static_cast<float>(std::clamp(confidence, 0.0, 1.0)) : 0.0f;
    if (columns_.timestamp && ParseNumber(cells_[*columns_.timestamp], &time)) {
      if (table->first_timed < 0) {
        table->first_timed = row->frame;
        table->first_time = time;
      }
      table->last_timed = row->frame;
      table->last_time = time;
    }
    return Status();
  }

  const Columns& columns_;
  const std::int64_t max_rows_;
  std::vector<std::string_view> cells_;
};

// The rate at which `table` was recorded; nothing where its timestamps do not tell.
std::optional<double> RateOf(const Table& table) {
  const double seconds = table.last_time - table.first_time;
  const auto frames = static_cast<double>(table.last_timed - table.first_timed);
  const double rate = frames / seconds;
  if (!(seconds > 0) || !CheckFrameRate(rate, "").ok()) return std::nullopt;
  // Each of the two times may be off by half a millisecond; a little more for our own rounding.
  constexpr double kRounding = 1.001e-3;
  double best = rate, least = kRounding;
  for (const double usual :
       {15.0, 24e3 / 1001, 24.0, 25.0, 30e3 / 1001, 30.0, 50.0, 60e3 / 1001, 60.0}) {
    const double off = std::fabs(frames / usual - seconds);
    if (off > least) continue;
    best = usual;
    least = off;
  }
  return best;
}

// The face that is found in most frames, and how many there are.
std::pair<std::int64_t, std::size_t> ChooseFace(const std::vector<Row>& rows) {
  std::map<std::int64_t, std::int64_t> found;
  for (const Row& row : rows) found[row.face] += row.confidence > 0;
  const auto best = std::max_element(
      found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {best->first, found.size()};
}

Status Fill(const Table& table, std::int64_t face, Track* track) {
  const std::int64_t first = table.rows.front().frame, columns = track->point_count();
  std::int64_t last = -1;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Row& row = table.rows[i];
    if (row.face != face) continue;
    const std::int64_t t = row.frame - first;
    if (t == last) {
      return BadInput("frame " + std::to_string(row.frame) + ": face " + std::to_string(face) +
                      " is there twice, expected one row a frame and face");
    }
    last = t;
    for (std::int64_t c = 0; c < columns; ++c) {
      const float value = table.values[i * static_cast<std::size_t>(columns) + c];
      if (std::isnan(value)) continue;
      track->value(t, 0, c) = value;
      track->seen(t, c) = row.confidence;
    }
  }
  return Status();
}

Status ReadTable(LineReader* lines, const OpenFaceOptions& options, Columns* columns,
                 Table* table) {
  std::string_view line;
  Result<bool> more = lines->Next(&line);
  if (!more.ok()) return more.status();
  Result<Columns> found = FindColumns(*more ? line : "", options.columns);
  if (!found.ok()) return found.status();
  *columns = *std::move(found);
  TableReader reader(*columns, options.max_rows);
  while ((more = lines->Next(&line)).ok() && *more) {
    if (Trim(line).empty()) continue;
    GESTUS_RETURN_IF_ERROR(reader.Add(line, lines->number(), table));
  }
  if (!more.ok()) return more.status();
  if (table->rows.empty()) return BadInput("has no rows, expected one for each frame");
  return Status();
}

void Describe(const Table& table, std::int64_t face, std::size_t faces, bool timed,
              OpenFaceClip* clip) {
  const Track& track = clip->track;
  if (faces > 1) {
    clip->notes.push_back(Count(faces, "face") + ": face_id " + std::to_string(face) +
                          " is kept, which is found in most frames");
  }
  if (!timed) {
    clip->notes.push_back("no timestamps that tell the frame rate: " +
                          Significant(track.frame_rate, 6) + " is taken");
  }
  std::int64_t lost = 0;
  for (std::int64_t t = 0; t < track.frames; ++t) {
    const auto* begin = track.confidence.data() + t * track.point_count();
    lost += std::all_of(begin, begin + track.point_count(), [](float c) { return c <= 0; });
  }
  if (lost > 0) {
    clip->notes.push_back(Count(static_cast<std::uint64_t>(lost), "frame") +
                          " without the face: taken as lost");
  }
  if (table.no_numbers > 0) {
    clip->notes.push_back(Count(static_cast<std::uint64_t>(table.no_numbers), "cell") +
                          " without a number: taken as lost");
  }
}

Result<OpenFaceClip> Read(const std::string& path, const OpenFaceOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckFrameRate(options.frame_rate, "the frame rate"));
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines.ok()) return lines.status();
  Columns columns;
  Table table;
  GESTUS_RETURN_IF_ERROR(ReadTable(&*lines, options, &columns, &table));
  const std::vector<Row>& rows = table.rows;
  const Result<std::int64_t> frames =
      CountFrames(rows.front().frame, rows.back().frame, std::ssize(rows), options.max_frames);
  if (!frames.ok()) return frames.status();

  const auto [face, faces] = ChooseFace(rows);
  const std::optional<double> rate = RateOf(table);
  OpenFaceClip clip;
  clip.track = Track(std::move(columns.names), 1, *frames, rate.value_or(options.frame_rate));
  GESTUS_RETURN_IF_ERROR(Fill(table, face, &clip.track));
  const std::vector<float>& confidence = clip.track.confidence;
  if (std::none_of(confidence.begin(), confidence.end(), [](float c) { return c > 0; })) {
    return BadInput("no face in any of " + Count(static_cast<std::uint64_t>(*frames), "frame") +
                    ", expected one with success 1");
  }
  Describe(table, face, faces, rate.has_value(), &clip);
  return clip;
}

}  // namespace

Result<OpenFaceClip> ReadOpenFace(const std::string& path, const OpenFaceOptions& options) {
  Result<OpenFaceClip> clip = Read(path, options);
  return clip.ok() ? std::move(clip) : clip.status().In(path);
}

}  // namespace gestus::motion
