#include "models/outputs/greta_file.h"

#include <cmath>
#include <utility>

#include "models/motion/resample.h"

namespace gestus::outputs {

Result<Motion> CurvesAtGretasRate(const Motion& motion) {
  motion::Track track(std::vector<std::string>(motion.curves->curves.size(), ""), 1, motion.frames,
                      motion.frame_rate);
  track.values = motion.curves->values;
  Result<motion::Track> resampled = motion::Resample(track, kGretaRate);
  if (!resampled.ok()) return resampled.status();
  Motion made;
  made.frame_rate = kGretaRate;
  made.frames = resampled->frames;
  made.curves = Curves{motion.curves->curves, std::move(resampled->values)};
  return made;
}

Result<GretaFile> GretaFile::Create(const std::string& path, const std::string& name,
                                    std::int64_t frames, const std::vector<bool>& used) {
  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  GretaFile greta(*std::move(file), used);
  GESTUS_RETURN_IF_ERROR(greta.file_.Add("2.1 " + name + " 25 " + std::to_string(frames) + "\n"));
  return greta;
}

Status GretaFile::Add(std::int64_t frame, const std::vector<double>& values) {
  std::string text;
  for (std::size_t n = 1; n < used_.size(); ++n) text += used_[n] ? "1 " : "0 ";
  text += "\n" + std::to_string(frame) + " ";
  for (std::size_t n = 1; n < used_.size(); ++n) {
    if (used_[n]) text += std::to_string(std::llround(values[n])) + " ";
  }
  return file_.Add(text + "\n");
}

}  // namespace gestus::outputs
