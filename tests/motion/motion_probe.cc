// Runs one step of the motion front end on raw float32 files, for clean_test.py.
//
//   motion_probe clean  MEDIAN ORDER LEAST COORDINATES POINTS RATE TRACK OUT
//   motion_probe resample TO_RATE - - COORDINATES POINTS RATE TRACK OUT
//   motion_probe columns SOURCE - - 2 52 RATE TRACK OUT      every joint, as PATS has it
//   motion_probe openface - - - - - - CSV OUT
//
// TRACK holds the values, then the confidences, of as many frames as fit; OUT likewise.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "models/io/reading.h"
#include "models/motion/clean.h"
#include "models/motion/openface.h"
#include "models/motion/resample.h"
#include "models/motion/select.h"

namespace gestus::motion {
namespace {

double Number(const char* text) {
  double value = 0;
  return ParseNumber(text, &value) ? value : 0;
}

Track ReadTrack(const char* path, std::int64_t coordinates, std::int64_t points, double rate) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const auto row = static_cast<std::size_t>((coordinates + 1) * points) * sizeof(float);
  Track track(std::vector<std::string>(static_cast<std::size_t>(points), "point"), coordinates,
              static_cast<std::int64_t>(bytes.size() / row), rate);
  const std::size_t split = track.values.size() * sizeof(float);
  bytes.copy(reinterpret_cast<char*>(track.values.data()), split);
  bytes.copy(reinterpret_cast<char*>(track.confidence.data()), bytes.size() - split, split);
  return track;
}

int Write(const char* path, const std::vector<float>& a, const std::vector<float>& b) {
  std::ofstream file(path, std::ios::binary);
  for (const auto* x : {&a, &b}) {
    file.write(reinterpret_cast<const char*>(x->data()),
               static_cast<std::streamsize>(x->size() * sizeof(float)));
  }
  return file.good() ? 0 : 1;
}

int Fail(const Status& status) {
  std::fprintf(stderr, "motion_probe: %s\n", status.message().c_str());
  return 2;
}

int Run(char** a) {
  const std::string step = a[1];
  if (step == "openface") {
    const auto clip = ReadOpenFace(a[8]);
    if (!clip.ok()) return Fail(clip.status());
    return Write(a[9], clip->track.values, clip->track.confidence);
  }
  Track track = ReadTrack(a[8], static_cast<std::int64_t>(Number(a[5])),
                          static_cast<std::int64_t>(Number(a[6])), Number(a[7]));
  if (step == "clean") {
    const auto report =
        Clean(&track, {.median = static_cast<int>(Number(a[2])),
                       .order = *a[3] == 'f' ? CleanOrder::kFillFirst : CleanOrder::kMedianFirst,
                       .min_confidence = static_cast<float>(Number(a[4]))});
    if (!report.ok()) return Fail(report.status());
    return Write(a[9], track.values, track.confidence);
  }
  if (step == "resample") {
    const auto made = Resample(track, Number(a[2]));
    if (!made.ok()) return Fail(made.status());
    return Write(a[9], made->values, made->confidence);
  }
  PoseLayout layout;
  layout.source = *a[2] == 'n' ? PoseSource::kNormalize : PoseSource::kData;
  for (std::int32_t j = 0; j < 52; ++j) layout.joints.push_back(j);
  const auto stances = FindStances(track);
  if (!stances.ok()) return Fail(stances.status());
  const auto columns = PoseColumns(track, layout, stances->frames);
  if (!columns.ok()) return Fail(columns.status());
  return Write(a[9], *columns, {});
}

}  // namespace
}  // namespace gestus::motion

int main(int argc, char** argv) { return argc == 10 ? gestus::motion::Run(argv) : 1; }
