// Every value of a motion in one table: time, then the body, the face and the curves.
#include <string>

#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

// A cell of RFC 4180: quoted where it has to be.
std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string Header(const Motion& motion) {
  std::string line = "time";
  for (const auto* figure : {&motion.body, &motion.face}) {
    if (!*figure) continue;
    const std::string prefix = figure == &motion.body ? "body_" : "face_";
    for (const char* coordinate : {"_x", "_y"}) {
      for (const Point& point : (*figure)->points)
        line += "," + Cell(prefix + point.name + coordinate);
    }
  }
  if (motion.curves) {
    for (const Curve& curve : motion.curves->curves) line += "," + Cell(curve.name);
  }
  return line + "\n";
}

void AppendRow(const std::vector<float>& values, std::int64_t frame, std::int64_t columns,
               std::string* row) {
  for (std::int64_t i = 0; i < columns; ++i) {
    *row += ',';
    AppendExact(row, values[static_cast<std::size_t>(frame * columns + i)]);
  }
}

}  // namespace

Status WriteCsv(const Motion& motion, const std::string& path) {
  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  GESTUS_RETURN_IF_ERROR(file->Add(Header(motion)));
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    std::string row;
    AppendFixed(&row, static_cast<double>(t) / motion.frame_rate, 6);
    for (const auto* figure : {&motion.body, &motion.face}) {
      if (*figure) AppendRow((*figure)->values, t, (*figure)->columns(), &row);
    }
    if (motion.curves) AppendRow(motion.curves->values, t, std::ssize(motion.curves->curves), &row);
    GESTUS_RETURN_IF_ERROR(file->Add(row + "\n"));
  }
  return file->Commit();
}

}  // namespace gestus::outputs
