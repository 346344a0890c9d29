#include "models/player/show.h"

#include <algorithm>
#include <cmath>

namespace gestus::player {
namespace {

using outputs::Curves;
using outputs::Figure;
using outputs::Motion;

Status Misfit(const std::string& what, const std::string& expected) {
  return Status(Code::kInvalidArgument, what + ": cannot be shown, expected " + expected);
}

Status CheckFigure(const std::string& name, const Figure& figure, std::int64_t frames) {
  if (figure.points.empty()) return Misfit(name, "a point or more");
  if (figure.values.size() != static_cast<std::size_t>(frames * figure.columns()))
    return Misfit(name, "x and y of every point in every frame");
  const auto points = static_cast<std::int64_t>(figure.points.size());
  for (const outputs::Point& point : figure.points) {
    if (point.parent < -1 || point.parent >= points)
      return Misfit(name, "parents among its " + std::to_string(points) + " points");
  }
  return Status();
}

Status CheckMotion(const std::string& role, const Motion& motion) {
  if (motion.frames < 1) return Misfit(role, "a frame or more");
  if (!(motion.frame_rate > 0) || !std::isfinite(motion.frame_rate))
    return Misfit(role, "a frame rate above 0");
  if (motion.body)
    GESTUS_RETURN_IF_ERROR(CheckFigure(role + ": body", *motion.body, motion.frames));
  if (motion.face)
    GESTUS_RETURN_IF_ERROR(CheckFigure(role + ": face", *motion.face, motion.frames));
  if (motion.curves && motion.curves->values.size() !=
                           static_cast<std::size_t>(motion.frames) * motion.curves->curves.size())
    return Misfit(role + ": curves", "a value of every curve in every frame");
  return Status();
}

}  // namespace

double Show::seconds() const {
  double longest = std::max(prediction.seconds(), sound.seconds());
  if (source) longest = std::max(longest, source->seconds());
  if (target) longest = std::max(longest, target->seconds());
  return longest;
}

std::vector<Take> TakesOf(const Show& show) {
  std::vector<Take> takes;
  if (show.source) takes.push_back({"source", &*show.source});
  takes.push_back({"prediction", &show.prediction});
  if (show.target) takes.push_back({"target", &*show.target});
  return takes;
}

Status CheckShow(const Show& show) {
  for (const Take& take : TakesOf(show))
    GESTUS_RETURN_IF_ERROR(CheckMotion(take.role, *take.motion));
  const Spectrogram& picture = show.spectrogram;
  if (picture.bins < 0 || (picture.bins == 0 && !picture.values.empty()) ||
      (picture.bins > 0 && picture.values.size() % static_cast<std::size_t>(picture.bins) != 0))
    return Misfit("spectrogram", "whole rows");
  if (!picture.values.empty() && !(picture.rate > 0))
    return Misfit("spectrogram", "a rate above 0");
  if (!show.pitch.hz.empty() && !(show.pitch.rate > 0)) return Misfit("pitch", "a rate above 0");
  if (!show.sound.samples.empty() && show.sound.sample_rate <= 0)
    return Misfit("sound", "a sample rate above 0");
  return Status();
}

}  // namespace gestus::player
