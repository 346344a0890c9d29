// Writes a motion made of raw float32 values, for export_test.py.
//
//   export_probe FORMAT SPEC VALUES OUT
//
// SPEC is a text file of lines: "rate 15", "normalised 0", "halve", "name wave", "stance X Y
// SHOULDER", "body NAME PARENT SOURCE" and "face NAME PARENT SOURCE" a point, "neck 0", "curve
// NAME".  VALUES holds the frames of the body, then those of the face and of the curves.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "models/outputs/formats.h"

namespace gestus::outputs {
namespace {

struct Input {
  Motion motion;
  FormatOptions options;
};

Input ReadSpec(const char* path) {
  Input input;
  std::ifstream file(path);
  for (std::string line, key, name; std::getline(file, line);) {
    std::istringstream words(line);
    words >> key;
    if (key == "rate") words >> input.motion.frame_rate;
    if (key == "normalised") words >> input.motion.normalised;
    if (key == "halve") input.options.halve = true;
    if (key == "name") words >> input.options.name;
    if (key == "neck") words >> input.motion.body->neck_is_position;
    if (key == "stance") {
      motion::Stance stance;
      words >> stance.neck_x >> stance.neck_y >> stance.shoulder;
      input.options.stances.push_back(stance);
    }
    if (key == "body" || key == "face") {
      auto& figure = key == "body" ? input.motion.body : input.motion.face;
      Point point;
      words >> point.name >> point.parent >> point.source;
      if (!figure) figure.emplace();
      figure->points.push_back(point);
    }
    if (key == "curve") {
      if (!input.motion.curves) input.motion.curves.emplace();
      words >> name;
      input.motion.curves->curves.push_back({name, "", 0, 5});
    }
  }
  return input;
}

void ReadValues(const char* path, Motion* motion) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  std::vector<float> values(bytes.size() / sizeof(float));
  bytes.copy(reinterpret_cast<char*>(values.data()), values.size() * sizeof(float));
  std::int64_t columns = 0;
  for (const auto* figure : {&motion->body, &motion->face})
    columns += *figure ? (*figure)->columns() : 0;
  if (motion->curves) columns += std::ssize(motion->curves->curves);
  motion->frames = columns == 0 ? 0 : std::ssize(values) / columns;
  auto at = values.begin();
  const auto take = [&](std::int64_t width, std::vector<float>* into) {
    into->assign(at, at + motion->frames * width);
    at += motion->frames * width;
  };
  for (auto* figure : {&motion->body, &motion->face}) {
    if (*figure) take((*figure)->columns(), &(*figure)->values);
  }
  if (motion->curves) take(std::ssize(motion->curves->curves), &motion->curves->values);
}

int Run(char** argv) {
  const Result<Format> format = FormatOf(argv[1]);
  Input input = ReadSpec(argv[2]);
  ReadValues(argv[3], &input.motion);
  const Status status =
      format.ok() ? WriteMotion(input.motion, *format, argv[4], input.options) : format.status();
  if (status.ok()) return 0;
  std::fprintf(stderr, "export_probe: %s\n", status.message().c_str());
  return 2;
}

}  // namespace
}  // namespace gestus::outputs

int main(int argc, char** argv) { return argc == 5 ? gestus::outputs::Run(argv) : 1; }
