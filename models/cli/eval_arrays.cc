// ReadMotionArrays: which points and channels the columns of arrays are.  A weights file says it;
// without one they are taken for those that the thesis' networks have.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/cli/eval_sequences.h"
#include "models/cli/finish.h"
#include "models/cli/npy.h"
#include "models/cli/npz.h"
#include "models/io/text.h"
#include "models/motion/clip.h"
#include "models/motion/joints.h"
#include "models/motion/resample.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::Arrays;
using models::ArraySpec;
using outputs::Figure;
using Numbers = std::vector<std::int64_t>;

constexpr double kPoseRate = 15, kCurveRate = 24;
// Fifteen of OpenPose's face points (thesis 7.4), as converters/kinds/zs_mstm2.py takes them.
constexpr std::int64_t kLandmarks[] = {0, 4, 8, 12, 16, 17, 19, 21, 22, 24, 26, 37, 41, 44, 46};
constexpr const char* kChannels[] = {"AU01", "AU02", "AU04", "AU05", "AU06",
                                     "AU07", "Rx",   "Ry",   "Rz"};
const ArrayLayout kAssumed;

Status Misshapen(const std::string& name, const Array& array, const std::string& expected) {
  return Status(Code::kBadInput, name + ": " + ShapeText(array.shape) + ", expected " + expected);
}

bool MakesPoses(const ArrayLayout& layout) {
  return layout.network->config_type() == fb::Config::ZsMstm1Config ||
         layout.network->config_type() == fb::Config::ZsMstm2Config;
}

const flatbuffers::Vector<flatbuffers::Offset<fb::Channel>>* ChannelsOf(const ArrayLayout& layout) {
  if (layout.network->config_type() == fb::Config::Model1Config)
    return layout.network->config_as_Model1Config()->channels();
  if (layout.network->config_type() == fb::Config::Model2Config)
    return layout.network->config_as_Model2Config()->channels();
  return nullptr;
}

Numbers FirstOf(std::int64_t n) {
  Numbers numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  return numbers;
}

Result<Arrays> Read(const std::string& path) {
  const Result<std::vector<std::string>> names = ListNpz(path);
  if (!names.ok()) return names.status();
  const auto has = [&](const std::string& name) {
    return std::find(names->begin(), names->end(), name) != names->end();
  };
  // Clips of a speaker have the same under other names.
  const std::string prefix = has("pose") || has("face") ? "" : "style_";
  std::vector<ArraySpec> wanted;
  for (const std::string& name : {prefix + "pose", prefix + "face", std::string(kFrameRate)}) {
    wanted.emplace_back().name = name;
    wanted.back().required = false;
  }
  for (const char* name : {"lengths", "times_ms"}) {
    wanted.emplace_back().name = name;
    wanted.back().dtype = DType::kI32;
    wanted.back().required = false;
  }
  Result<NpzContents> contents = ReadNpz(path, wanted);
  if (!contents.ok()) return contents.status();
  Arrays arrays;
  for (auto& [name, array] : contents->arrays)
    arrays[name.starts_with(prefix) ? name.substr(prefix.size()) : name] = std::move(array);
  if (arrays.count("pose") == 0 && arrays.count("face") == 0)
    return Status(Code::kBadInput,
                  path + ": holds no motion, expected an array pose, or face and lengths");
  return arrays;
}

/// The network that makes poses like these, or what is assumed.
const ArrayLayout& PoseLayout(const std::vector<ArrayLayout>& layouts, const Arrays& arrays) {
  const auto pose = arrays.find("pose");
  for (const ArrayLayout& layout : layouts) {
    if (!MakesPoses(layout)) continue;
    const auto joints = static_cast<std::int64_t>(layout.spec.joints.size());
    if (pose == arrays.end() || pose->second.shape.size() != 2 ||
        pose->second.shape[1] == 2 * joints)
      return layout;
  }
  return kAssumed;
}

Result<Figure> FigureOf(const std::string& name, const Array& array, Numbers sources,
                        const std::vector<std::string>& names) {
  const auto most = static_cast<std::int64_t>(names.size());
  if (array.shape.size() != 2 || array.shape[1] % 2 != 0 || array.shape[1] > 2 * most)
    return Misshapen(name, array,
                     "(frames, 2 * points), at most " + std::to_string(most) + " points");
  if (2 * static_cast<std::int64_t>(sources.size()) != array.shape[1])
    sources = FirstOf(array.shape[1] / 2);
  Figure figure;
  figure.values = array.f32;
  for (const std::int64_t source : sources)
    figure.points.push_back({names[static_cast<std::size_t>(source)], -1, source});
  return figure;
}

Status AddPoints(const Arrays& arrays, const ArrayLayout& layout, Sequence* sequence,
                 std::vector<std::string>* notes) {
  outputs::Motion& motion = sequence->motion;
  if (const auto pose = arrays.find("pose"); pose != arrays.end()) {
    Result<Figure> body =
        FigureOf("pose", pose->second, layout.spec.joints, motion::PatsJointNames());
    if (!body.ok()) return body.status();
    motion.body = *std::move(body);
    motion.frames = pose->second.shape[0];
    if (layout.network == nullptr)
      notes->push_back("poses: their columns were taken for PATS' first " +
                       std::to_string(motion.body->points.size()) +
                       " joints; --weights would tell");
  }
  const auto face = arrays.find("face");
  if (face == arrays.end()) return Status();
  Numbers landmarks = layout.spec.landmarks;
  if (landmarks.empty()) landmarks.assign(std::begin(kLandmarks), std::end(kLandmarks));
  Result<Figure> points =
      FigureOf("face", face->second, std::move(landmarks), motion::FacePointNames());
  if (!points.ok()) return points.status();
  if (motion.body && face->second.shape[0] != motion.frames)
    return Misshapen("face", face->second,
                     "as many frames as pose, " + std::to_string(motion.frames));
  motion.face = *std::move(points);
  motion.frames = face->second.shape[0];
  return Status();
}

Status CheckCurves(const Arrays& arrays, double rate) {
  const Array& face = arrays.at("face");
  const std::int64_t items = face.shape[0];
  const auto lengths = arrays.find("lengths");
  if (lengths == arrays.end())
    return Status(Code::kBadInput, "lengths: missing, expected how long each sequence of face is");
  if (lengths->second.shape != std::vector<std::int64_t>{items, face.shape[2]})
    return Misshapen("lengths", lengths->second,
                     "(" + std::to_string(items) + ", " + std::to_string(face.shape[2]) + ")");
  for (const std::int32_t length : lengths->second.i32) {
    if (length < 0 || length > face.shape[1])
      return Status(Code::kBadInput, "lengths: " + std::to_string(length) + ", expected 0 to " +
                                         std::to_string(face.shape[1]) + ", the steps of face");
  }
  const auto times = arrays.find("times_ms");
  if (times != arrays.end() && times->second.shape != std::vector<std::int64_t>{items, 2})
    return Misshapen("times_ms", times->second, "(" + std::to_string(items) + ", 2)");
  if (times == arrays.end()) return Status();
  for (const std::int32_t ms : times->second.i32) {
    if (ms < 0 || ms * rate / 1000 > static_cast<double>(motion::kMaxFrames))
      return Status(Code::kBadInput, "times_ms: " + std::to_string(ms) + ", expected 0 to " +
                                         std::to_string(motion::kMaxFrames) + " frames");
  }
  return Status();
}

std::vector<EvalChannel> ChannelsFor(std::int64_t count, const std::vector<ArrayLayout>& layouts) {
  std::vector<EvalChannel> channels;
  for (const ArrayLayout& layout : layouts) {
    const auto* const known = ChannelsOf(layout);
    if (known == nullptr || static_cast<std::int64_t>(known->size()) != count) continue;
    for (const fb::Channel* channel : *known)
      channels.push_back(
          {channel->name()->str(), channel->unit() == nullptr ? "" : channel->unit()->str(), {}});
    return channels;
  }
  const bool usual = count == static_cast<std::int64_t>(std::size(kChannels));
  for (std::int64_t n = 0; n < count; ++n) {
    const std::string name = usual ? kChannels[n] : "channel " + std::to_string(n);
    channels.push_back({name,
                        !usual                   ? ""
                        : name.starts_with("AU") ? "intensity 0 to 5"
                                                 : "rad",
                        {}});
  }
  return channels;
}

void AddCurves(const Arrays& arrays, const std::vector<ArrayLayout>& layouts, Sequence* sequence) {
  const Array &face = arrays.at("face"), &lengths = arrays.at("lengths");
  const std::int64_t items = face.shape[0], steps = face.shape[1], count = face.shape[2];
  const auto times = arrays.find("times_ms");
  sequence->timed = times != arrays.end();
  sequence->channels = ChannelsFor(count, layouts);
  for (std::int64_t item = 0; item < items; ++item) {
    std::int64_t longest = 0;
    for (std::int64_t n = 0; n < count; ++n) {
      const std::int64_t length = lengths.i32[static_cast<std::size_t>(item * count + n)];
      Stretch stretch;
      if (sequence->timed)
        stretch.begin = std::llround(times->second.i32[static_cast<std::size_t>(2 * item)] *
                                     sequence->motion.frame_rate / 1000);
      for (std::int64_t step = 0; step < length; ++step)
        stretch.values.push_back(
            face.f32[static_cast<std::size_t>((item * steps + step) * count + n)]);
      sequence->channels[static_cast<std::size_t>(n)].stretches.push_back(std::move(stretch));
      longest = std::max(longest, length);
    }
    sequence->motion.frames += longest;
  }
}

/// `values` (frames, coordinates * points) at another rate.
Status Resample(std::int64_t points, std::int64_t coordinates, std::int64_t frames, double from,
                double to, std::vector<float>* values) {
  motion::Track track(std::vector<std::string>(static_cast<std::size_t>(points)), coordinates,
                      frames, from);
  track.values = std::move(*values);
  Result<motion::Track> resampled = motion::Resample(track, to);
  if (!resampled.ok()) return resampled.status();
  *values = std::move(resampled->values);
  return Status();
}

/// Everything of `sequence` at the rate `wanted`; of curves only those that go on from the first
/// frame to the last: words and windows have their places in frames.
Status BringTo(double wanted, const std::string& path, Sequence* sequence,
               std::vector<std::string>* notes) {
  outputs::Motion& motion = sequence->motion;
  const double own = motion.frame_rate;
  if (wanted <= 0 || motion.frames == 0 || std::abs(own / wanted - 1) <= 1e-3) return Status();
  for (EvalChannel& channel : sequence->channels) {
    if (sequence->timed || channel.stretches.size() != 1)
      return Status(Code::kBadInput, "curves at " + Significant(own, 4) +
                                         " frames per second, expected " + Significant(wanted, 4) +
                                         " as the first prediction has");
    std::vector<float>& values = channel.stretches[0].values;
    GESTUS_RETURN_IF_ERROR(Resample(1, 1, std::ssize(values), own, wanted, &values));
    motion.frames = std::ssize(values);
  }
  for (auto* figure : {&motion.body, &motion.face}) {
    if (!*figure) continue;
    const std::int64_t points = std::ssize((*figure)->points);
    const std::int64_t frames = std::ssize((*figure)->values) / (2 * points);
    GESTUS_RETURN_IF_ERROR(Resample(points, 2, frames, own, wanted, &(*figure)->values));
    motion.frames = std::ssize((*figure)->values) / (2 * points);
  }
  motion.frame_rate = wanted;
  notes->push_back(path + ": resampled from " + Significant(own, 4) + " to " +
                   Significant(wanted, 4) + " frames per second");
  return Status();
}

}  // namespace

Result<Sequence> ReadMotionArrays(const std::string& path, const std::vector<ArrayLayout>& layouts,
                                  double declared, double wanted, std::vector<std::string>* notes) {
  Result<Arrays> arrays = Read(path);
  if (!arrays.ok()) return arrays.status();
  double finished = 0;
  GESTUS_RETURN_IF_ERROR(TakeFinished(&*arrays, &finished).In(path));
  const auto rate_or = [&](double usual) {
    return finished > 0 ? finished : declared > 0 ? declared : usual;
  };
  Sequence sequence;
  const auto face = arrays->find("face");
  if (face != arrays->end() && face->second.shape.size() == 3) {
    sequence.motion.frame_rate = rate_or(kCurveRate);
    GESTUS_RETURN_IF_ERROR(CheckCurves(*arrays, sequence.motion.frame_rate).In(path));
    AddCurves(*arrays, layouts, &sequence);
    GESTUS_RETURN_IF_ERROR(BringTo(wanted, path, &sequence, notes).In(path));
    return sequence;
  }
  const ArrayLayout& layout = PoseLayout(layouts, *arrays);
  const double own = layout.network == nullptr ? kPoseRate : layout.spec.frame_rate;
  sequence.motion.frame_rate = rate_or(own);
  GESTUS_RETURN_IF_ERROR(AddPoints(*arrays, layout, &sequence, notes).In(path));
  GESTUS_RETURN_IF_ERROR(BringTo(wanted, path, &sequence, notes).In(path));
  return sequence;
}

}  // namespace gestus::cli
