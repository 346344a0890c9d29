#include "models/outputs/motion.h"

#include <algorithm>
#include <cmath>

#include "weights_generated.h"

namespace gestus::outputs {
namespace {

using models::Array;
using models::Arrays;

const Array* Find(const Arrays& arrays, const char* name) {
  const auto found = arrays.find(name);
  return found == arrays.end() ? nullptr : &found->second;
}

Status Misfit(const std::string& name, const std::string& expected) {
  return Status(Code::kBadInput, name + ": does not fit the network, expected " + expected);
}

std::vector<Point> PointsOf(const flatbuffers::Vector<flatbuffers::Offset<fb::Joint>>* joints,
                            std::int64_t count) {
  std::vector<Point> points;
  if (joints != nullptr && joints->size() == static_cast<std::size_t>(count)) {
    for (const fb::Joint* joint : *joints)
      points.push_back({joint->name()->str(), joint->parent(), joint->source()});
    return points;
  }
  // A file that names no points still has them.
  for (std::int64_t i = 0; i < count; ++i) points.push_back({"point" + std::to_string(i), -1, i});
  return points;
}

Result<Figure> FigureOf(const std::string& name, const Array& array, std::int64_t columns,
                        const flatbuffers::Vector<flatbuffers::Offset<fb::Joint>>* joints) {
  if (array.dtype != DType::kF32 || array.shape.size() != 2 || array.shape[1] != columns ||
      columns % 2 != 0)
    return Misfit(name, "(frames, " + std::to_string(columns) + ") float32");
  Figure figure;
  figure.points = PointsOf(joints, columns / 2);
  figure.values = array.f32;
  return figure;
}

/// ZS-MSTM 1.0 and 2.0.
Result<Motion> PosesOf(const fb::Network& record, const Arrays& outputs) {
  const bool second = record.config_type() == fb::Config::ZsMstm2Config;
  const fb::ZsMstm1Config& core =
      second ? *record.config_as_ZsMstm2Config()->core() : *record.config_as_ZsMstm1Config();
  const Array* pose = Find(outputs, "pose");
  if (pose == nullptr) return Misfit("pose", "the poses that it makes");
  Motion motion;
  motion.frame_rate = core.frame_rate();
  motion.normalised = core.pose_source() == fb::PoseSource::Normalize;
  Result<Figure> body = FigureOf("pose", *pose, core.d_pose(), record.joints());
  if (!body.ok()) return body.status();
  body->neck_is_position =
      record.features() == nullptr || record.features()->neck() == fb::NeckColumns::Position;
  motion.frames = pose->shape[0];
  motion.body = *std::move(body);
  const std::int64_t segment = core.granularity() == fb::Granularity::Segment
                                   ? std::int64_t{core.frames()} * core.context_segments()
                                   : core.frames();
  for (std::int64_t at = segment; at < motion.frames; at += segment) motion.seams.push_back(at);
  const Array* face = second ? Find(outputs, "face") : nullptr;
  if (face == nullptr) return motion;
  Result<Figure> points =
      FigureOf("face", *face, record.config_as_ZsMstm2Config()->d_face(),
               record.features() == nullptr ? nullptr : record.features()->landmarks());
  if (!points.ok()) return points.status();
  if (face->shape[0] != motion.frames)
    return Misfit("face", std::to_string(motion.frames) + " frames, those of pose");
  motion.face = *std::move(points);
  return motion;
}

/// One sequence of one channel, placed in time.
struct Stretch {
  std::int64_t begin;  // frame
  std::vector<float> values;
};

/// `stretches` over `frames` frames, straight lines between them.
void Join(const std::vector<Stretch>& stretches, std::int64_t frames, std::size_t column,
          std::size_t columns, std::vector<float>* out) {
  const auto at = [&](std::int64_t frame) -> float& {
    return (*out)[static_cast<std::size_t>(frame) * columns + column];
  };
  std::int64_t last = -1;  // frame of the last value that is there
  float value = 0;
  for (const Stretch& stretch : stretches) {
    for (std::size_t i = 0; i < stretch.values.size(); ++i) {
      const std::int64_t frame = stretch.begin + static_cast<std::int64_t>(i);
      if (frame <= last || frame >= frames) continue;
      const float next = stretch.values[i];
      for (std::int64_t gap = last + 1; gap < frame; ++gap) {
        const float share = static_cast<float>(gap - last) / static_cast<float>(frame - last);
        at(gap) = last < 0 ? next : value + share * (next - value);
      }
      at(frame) = value = next;
      last = frame;
    }
  }
  for (std::int64_t frame = last + 1; frame < frames; ++frame) at(frame) = value;
}

/// When each sequence begins and ends, in frames.
std::vector<std::pair<std::int64_t, std::int64_t>> TimesOf(const Arrays& outputs,
                                                           const Array& lengths, double rate) {
  std::vector<std::pair<std::int64_t, std::int64_t>> times;
  const std::int64_t items = lengths.shape[0], channels = lengths.shape[1];
  const Array* ms = Find(outputs, "times_ms");
  std::int64_t at = 0;
  for (std::int64_t item = 0; item < items; ++item) {
    if (ms != nullptr) {
      const auto frame = [&](std::int64_t end) {
        return std::llround(ms->i32[static_cast<std::size_t>(2 * item + end)] * rate / 1000);
      };
      times.emplace_back(frame(0), std::max<std::int64_t>(frame(0), frame(1)));
      continue;
    }
    std::int64_t longest = 0;
    for (std::int64_t n = 0; n < channels; ++n)
      longest = std::max<std::int64_t>(longest,
                                       lengths.i32[static_cast<std::size_t>(item * channels + n)]);
    times.emplace_back(at, at + longest);
    at += longest;
  }
  return times;
}

using Channels = flatbuffers::Vector<flatbuffers::Offset<fb::Channel>>;

std::vector<Curve> NamesOf(const Channels& channels) {
  std::vector<Curve> curves;
  for (const fb::Channel* channel : channels)
    curves.push_back(
        {channel->name()->str(), channel->unit() == nullptr ? "" : channel->unit()->str(),
         channel->minimum(),
         channel->minimum() + channel->step() * static_cast<float>(channel->levels() - 1)});
  return curves;
}

Status NoMotion(const fb::Network& record) {
  return Status(Code::kInvalidArgument, "network " + record.name()->str() +
                                            ": makes no motion, expected a gesture network");
}

/// Model 1 and Model 2.
Result<Motion> CurvesOf(const Channels& channels, const Arrays& outputs,
                        const CurveOptions& options) {
  const Array *face = Find(outputs, "face"), *lengths = Find(outputs, "lengths");
  const auto count = static_cast<std::int64_t>(channels.size());
  if (face == nullptr || face->shape.size() != 3 || face->shape[2] != count ||
      face->dtype != DType::kF32)
    return Misfit("face", "(items, steps, " + std::to_string(count) + ") float32");
  const std::int64_t items = face->shape[0], steps = face->shape[1];
  if (lengths == nullptr || lengths->shape != std::vector<std::int64_t>{items, count} ||
      lengths->dtype != DType::kI32)
    return Misfit("lengths", "(items, " + std::to_string(count) + ") int32");
  const Array* ms = Find(outputs, "times_ms");
  if (ms != nullptr &&
      (ms->shape != std::vector<std::int64_t>{items, 2} || ms->dtype != DType::kI32))
    return Misfit("times_ms", "(items, 2) int32");
  Motion motion;
  motion.frame_rate = options.frame_rate;
  const auto times = TimesOf(outputs, *lengths, options.frame_rate);
  for (const auto& [begin, end] : times) motion.frames = std::max(motion.frames, end);
  motion.frames = std::max<std::int64_t>(motion.frames, 1);
  Curves& curves = motion.curves.emplace();
  curves.curves = NamesOf(channels);
  curves.values.resize(static_cast<std::size_t>(motion.frames * count));
  for (std::int64_t n = 0; n < count; ++n) {
    std::vector<Stretch> stretches;
    for (std::int64_t item = 0; item < items; ++item) {
      const auto [begin, end] = times[static_cast<std::size_t>(item)];
      const std::int64_t next =
          item + 1 < items ? times[static_cast<std::size_t>(item) + 1].first : motion.frames;
      const std::int64_t length =
          std::clamp<std::int64_t>(lengths->i32[static_cast<std::size_t>(item * count + n)], 0,
                                   std::min(steps, std::max<std::int64_t>(next - begin, 0)));
      Stretch stretch{begin, {}};
      for (std::int64_t step = 0; step < length; ++step)
        stretch.values.push_back(
            face->f32[static_cast<std::size_t>((item * steps + step) * count + n)]);
      stretches.push_back(std::move(stretch));
    }
    Join(stretches, motion.frames, static_cast<std::size_t>(n), static_cast<std::size_t>(count),
         &curves.values);
  }
  for (std::size_t item = 1; item < times.size(); ++item) {
    const std::int64_t at = times[item].first;
    if (at > 0 && at < motion.frames && (motion.seams.empty() || motion.seams.back() < at))
      motion.seams.push_back(at);
  }
  return motion;
}

}  // namespace

Result<Motion> LayoutOf(const fb::Network& record) {
  Motion motion;
  const auto add_body = [&](const fb::ZsMstm1Config& core) {
    motion.body.emplace().points = PointsOf(record.joints(), core.d_pose() / 2);
  };
  switch (record.config_type()) {
    case fb::Config::ZsMstm1Config:
      add_body(*record.config_as_ZsMstm1Config());
      return motion;
    case fb::Config::ZsMstm2Config:
      add_body(*record.config_as_ZsMstm2Config()->core());
      motion.face.emplace().points =
          PointsOf(record.features() == nullptr ? nullptr : record.features()->landmarks(),
                   record.config_as_ZsMstm2Config()->d_face() / 2);
      return motion;
    case fb::Config::Model1Config:
      motion.curves.emplace().curves = NamesOf(*record.config_as_Model1Config()->channels());
      return motion;
    case fb::Config::Model2Config:
      motion.curves.emplace().curves = NamesOf(*record.config_as_Model2Config()->channels());
      return motion;
    default:
      return NoMotion(record);
  }
}

Result<Motion> MotionOf(const fb::Network& record, const Arrays& outputs,
                        const CurveOptions& options) {
  switch (record.config_type()) {
    case fb::Config::ZsMstm1Config:
    case fb::Config::ZsMstm2Config:
      return PosesOf(record, outputs);
    case fb::Config::Model1Config:
      return CurvesOf(*record.config_as_Model1Config()->channels(), outputs, options);
    case fb::Config::Model2Config:
      return CurvesOf(*record.config_as_Model2Config()->channels(), outputs, options);
    default:
      return NoMotion(record);
  }
}

}  // namespace gestus::outputs
