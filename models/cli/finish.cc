#include "models/cli/finish.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::Arrays;

void Put(const char* name, std::int64_t frames, const std::vector<float>& values, Arrays* arrays) {
  Array array;
  array.shape = {frames, static_cast<std::int64_t>(values.size()) / frames};
  array.f32 = values;
  (*arrays)[name] = std::move(array);
}

}  // namespace

Result<std::optional<outputs::Finished>> FinishOutputs(const Arguments& arguments,
                                                       const Setup& setup, Arrays* arrays,
                                                       models::RunReport* report) {
  if (!arguments.finish.has_value()) return std::optional<outputs::Finished>();
  const Result<outputs::Motion> motion =
      outputs::MotionOf(*setup.weights->FindNetwork(setup.name), *arrays);
  if (!motion.ok()) return motion.status().In(setup.weights->path());
  Result<outputs::Finished> done = outputs::Finish(*motion, *arguments.finish);
  if (!done.ok()) return done.status();
  const outputs::Motion& finished = done->motion;
  if (finished.body.has_value()) Put("pose", finished.frames, finished.body->values, arrays);
  if (finished.face.has_value()) Put("face", finished.frames, finished.face->values, arrays);
  if (finished.curves.has_value()) Put("face", finished.frames, finished.curves->values, arrays);
  Array rate;
  rate.f32 = {static_cast<float>(finished.frame_rate)};
  (*arrays)["frame_rate"] = std::move(rate);
  report->frames = static_cast<std::size_t>(finished.frames);
  report->frame_rate = finished.frame_rate;
  report->notes.insert(report->notes.end(), done->notes.begin(), done->notes.end());
  return std::optional<outputs::Finished>(*std::move(done));
}

}  // namespace gestus::cli
