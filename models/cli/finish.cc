#include "models/cli/finish.h"

#include "models/io/text.h"
#include "models/motion/clip.h"

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
  (*arrays)[kFrameRate] = std::move(rate);
  report->frames = static_cast<std::size_t>(finished.frames);
  report->frame_rate = finished.frame_rate;
  report->notes.insert(report->notes.end(), done->notes.begin(), done->notes.end());
  return std::optional<outputs::Finished>(*std::move(done));
}

Status TakeFinished(Arrays* arrays, double* rate) {
  *rate = 0;
  const auto found = arrays->find(kFrameRate);
  if (found == arrays->end()) return Status();
  if (found->second.f32.size() != 1)
    return Status(Code::kBadInput, std::string(kFrameRate) + ": " +
                                       Count(found->second.f32.size(), "value") + ", expected 1");
  *rate = found->second.f32[0];
  GESTUS_RETURN_IF_ERROR(motion::CheckFrameRate(*rate, kFrameRate));
  const auto face = arrays->find("face");
  if (face == arrays->end() || arrays->count("pose") != 0 || face->second.shape.size() != 2)
    return Status();
  // One sequence, all of it said.
  Array lengths;
  lengths.dtype = DType::kI32;
  lengths.shape = {1, face->second.shape[1]};
  lengths.i32.assign(static_cast<std::size_t>(face->second.shape[1]),
                     static_cast<std::int32_t>(face->second.shape[0]));
  face->second.shape.insert(face->second.shape.begin(), 1);
  (*arrays)["lengths"] = std::move(lengths);
  arrays->erase("times_ms");
  return Status();
}

}  // namespace gestus::cli
