// MPEG-4 face animation parameters of Greta, made of action units.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "models/outputs/face_curves.h"
#include "models/outputs/greta_file.h"

namespace gestus::outputs {
namespace {

constexpr int kFaps = 69;

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

}  // namespace

bool HasFap(const FaceCurves& face) {
  return std::any_of(kPulls.begin(), kPulls.end(),
                     [&](const Pull& pull) { return face.HasUnit(pull.unit); });
}

Status WriteFap(const Motion& motion, const std::string& path, const FormatOptions& options) {
  const FaceCurves given(motion);
  std::vector<bool> used(kFaps + 1);
  for (const Pull& pull : kPulls) {
    if (!given.HasUnit(pull.unit)) continue;
    used[static_cast<std::size_t>(pull.fap)] = used[static_cast<std::size_t>(pull.fap) + 1] = true;
  }
  const Result<Motion> resampled = CurvesAtGretasRate(motion);
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

}  // namespace gestus::outputs
