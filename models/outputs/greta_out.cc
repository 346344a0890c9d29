// Greta's text files of MPEG-4 animation parameters: action units as FAPs, the head as BAPs of a
// vertebra of the neck.  Of each frame one line says which parameters it sets and one their values.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "models/motion/resample.h"
#include "models/outputs/face_curves.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

constexpr double kRate = 25;  // Greta knows no other
constexpr int kFaps = 69, kBaps = 295;
// BAPs are radians x 100000.
constexpr double kBapUnit = 1e5;
constexpr int kNeckRoll = 57, kNeckTorsion = 58, kNeckTilt = 59;  // of vertebra C3

/// How far an action unit of intensity 5 moves a pair of points, in 1/1024 of the FAP's unit: of
/// the left side; that of the right side is the next one.
struct Pull {
  int unit, fap;
  double full;
};

// Brows 31 to 36 (unit ENS, up), their squeeze 37 (ES, inwards), upper lids 19 and lower lids 21
// (IRISD, closing), cheeks 41 (ENS, up).
constexpr std::array<Pull, 15> kPulls = {{{1, 31, 200},
                                          {1, 33, 100},
                                          {2, 33, 100},
                                          {2, 35, 200},
                                          {4, 31, -150},
                                          {4, 33, -100},
                                          {4, 35, -50},
                                          {4, 37, 100},
                                          {5, 19, -350},
                                          {6, 21, 200},
                                          {6, 41, 150},
                                          {7, 19, 250},
                                          {7, 21, 300},
                                          {45, 19, 600},
                                          {45, 21, 400}}};

/// The curves of `motion` at Greta's rate, between frames by straight lines.
Result<Motion> AtGretasRate(const Motion& motion) {
  motion::Track track(std::vector<std::string>(motion.curves->curves.size(), ""), 1, motion.frames,
                      motion.frame_rate);
  track.values = motion.curves->values;
  Result<motion::Track> resampled = motion::Resample(track, kRate);
  if (!resampled.ok()) return resampled.status();
  Motion made;
  made.frame_rate = kRate;
  made.frames = resampled->frames;
  made.curves = Curves{motion.curves->curves, std::move(resampled->values)};
  return made;
}

/// Sets `count` parameters, frame by frame; 0 in `used` for those that are left alone.
class GretaFile {
 public:
  static Result<GretaFile> Create(const std::string& path, const std::string& name,
                                  std::int64_t frames, const std::vector<bool>& used) {
    Result<TextFile> file = TextFile::Create(path);
    if (!file.ok()) return file.status();
    GretaFile greta(*std::move(file), used);
    GESTUS_RETURN_IF_ERROR(greta.file_.Add("2.1 " + name + " 25 " + std::to_string(frames) + "\n"));
    return greta;
  }

  /// `values[n]` of parameter n, from 1.
  Status Add(std::int64_t frame, const std::vector<double>& values) {
    std::string text;
    for (std::size_t n = 1; n < used_.size(); ++n) text += used_[n] ? "1 " : "0 ";
    text += "\n" + std::to_string(frame) + " ";
    for (std::size_t n = 1; n < used_.size(); ++n) {
      if (used_[n]) text += std::to_string(std::llround(values[n])) + " ";
    }
    return file_.Add(text + "\n");
  }

  Status Commit() { return file_.Commit(); }

 private:
  GretaFile(TextFile&& file, const std::vector<bool>& used) : file_(std::move(file)), used_(used) {}

  TextFile file_;
  std::vector<bool> used_;
};

}  // namespace

Status WriteFap(const Motion& motion, const std::string& path, const FormatOptions& options) {
  const FaceCurves given(motion);
  std::vector<bool> used(kFaps + 1);
  for (const Pull& pull : kPulls) {
    if (!given.HasUnit(pull.unit)) continue;
    used[static_cast<std::size_t>(pull.fap)] = used[static_cast<std::size_t>(pull.fap) + 1] = true;
  }
  if (std::find(used.begin(), used.end(), true) == used.end())
    return Lacks("action units of brows, lids or cheeks", Format::kFap);
  const Result<Motion> resampled = AtGretasRate(motion);
  if (!resampled.ok()) return resampled.status();
  const FaceCurves face(*resampled);
  Result<GretaFile> file =
      GretaFile::Create(path, ClipName(path, options), resampled->frames, used);
  if (!file.ok()) return file.status();
  for (std::int64_t t = 0; t < resampled->frames; ++t) {
    std::vector<double> values(kFaps + 1);
    for (const Pull& pull : kPulls) {
      for (const int side : {0, 1})
        values[static_cast<std::size_t>(pull.fap + side)] += pull.full * face.Weight(t, pull.unit);
    }
    GESTUS_RETURN_IF_ERROR(file->Add(t, values));
  }
  return file->Commit();
}

Status WriteBap(const Motion& motion, const std::string& path, const FormatOptions& options) {
  if (!FaceCurves(motion).HasHead()) return Lacks("head angles", Format::kBap);
  std::vector<bool> used(kBaps + 1);
  for (const int bap : {kNeckRoll, kNeckTorsion, kNeckTilt})
    used[static_cast<std::size_t>(bap)] = true;
  const Result<Motion> resampled = AtGretasRate(motion);
  if (!resampled.ok()) return resampled.status();
  const FaceCurves face(*resampled);
  Result<GretaFile> file =
      GretaFile::Create(path, ClipName(path, options), resampled->frames, used);
  if (!file.ok()) return file.status();
  for (std::int64_t t = 0; t < resampled->frames; ++t) {
    std::vector<double> values(kBaps + 1);
    values[kNeckTilt] = face.Angle(t, 0) * kBapUnit;
    values[kNeckTorsion] = -face.Angle(t, 1) * kBapUnit;
    values[kNeckRoll] = -face.Angle(t, 2) * kBapUnit;
    GESTUS_RETURN_IF_ERROR(file->Add(t, values));
  }
  return file->Commit();
}

}  // namespace gestus::outputs
