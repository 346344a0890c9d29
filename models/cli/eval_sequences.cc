// Opening weights, and the recordings: OpenFace's curves and OpenPose's figures.
#include "models/cli/eval_sequences.h"

#include <algorithm>
#include <cmath>

#include "models/features/figure.h"
#include "models/io/text.h"
#include "models/motion/clean.h"
#include "models/motion/joints.h"
#include "models/motion/openface.h"
#include "models/motion/resample.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using features::FeatureSpec;

/// "AU01_r" -> "AU01", "pose_Rx" -> "Rx"
std::string ChannelName(std::string column) {
  constexpr std::string_view kIntensity = "_r", kPose = "pose_";
  if (column.ends_with(kIntensity)) column.resize(column.size() - kIntensity.size());
  if (column.starts_with(kPose)) column.erase(0, kPose.size());
  return column;
}

/// Numbers of the points that were seen in any frame.
std::vector<std::int64_t> Seen(const motion::Track& track) {
  std::vector<std::int64_t> points;
  for (std::int64_t point = 0; point < track.point_count(); ++point) {
    if (track.Has(point)) points.push_back(point);
  }
  return points;
}

outputs::Figure FigureOf(const std::vector<std::int64_t>& sources,
                         const std::vector<std::string>& names, models::Array array) {
  outputs::Figure figure;
  figure.values = std::move(array.f32);
  for (const std::int64_t source : sources)
    figure.points.push_back({names[static_cast<std::size_t>(source)], -1, source});
  return figure;
}

}  // namespace

Result<SequenceReader> SequenceReader::Make(const Arguments& arguments) {
  SequenceReader reader;
  reader.array_rate_ = arguments.eval.rate;
  reader.pose_rate_ = arguments.pose_rate;
  if (arguments.weights.empty()) return reader;
  Result<std::shared_ptr<const WeightsFile>> weights = WeightsFile::Open(arguments.weights);
  if (!weights.ok()) return weights.status();
  reader.weights_ = *std::move(weights);
  GESTUS_RETURN_IF_ERROR(reader.FindLayouts(arguments.network));
  return reader;
}

Status SequenceReader::FindLayouts(const std::string& name) {
  if (!name.empty() && weights_->FindNetwork(name) == nullptr)
    return Status(Code::kInvalidArgument, weights_->path() + ": has no network " + name +
                                              ", expected one that infer-cli info lists");
  for (const fb::Network* network : *weights_->root().networks()) {
    if (!name.empty() && network->name()->str() != name) continue;
    switch (network->config_type()) {
      case fb::Config::ZsMstm1Config:
      case fb::Config::ZsMstm2Config:
      case fb::Config::Model1Config:
      case fb::Config::Model2Config:
        break;
      default:
        continue;  // makes no motion
    }
    Result<FeatureSpec> spec = features::ReadFeatureSpec(*network);
    if (!spec.ok()) return spec.status().In(weights_->path());
    layouts_.push_back({network, *std::move(spec)});
  }
  return Status();
}

Result<Sequence> SequenceReader::Read(const SequenceFile& file, double wanted) {
  const double rate = wanted > 0 ? wanted : array_rate_;
  std::vector<std::string> notes;
  Result<Sequence> sequence =
      file.kind == InputKind::kArrays
          ? ReadMotionArrays(file.path, layouts_, array_rate_, wanted, &notes)
      : file.kind == InputKind::kOpenFace ? ReadOpenFaceFile(file.path, rate)
                                          : ReadOpenPoseFolder(file.path, rate);
  if (!sequence.ok()) return sequence.status();
  for (const std::string& note : notes) {
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
  }
  sequence->name = file.name;
  sequence->path = file.path;
  return sequence;
}

Result<Sequence> SequenceReader::ReadOpenFaceFile(const std::string& path, double rate) {
  Result<motion::OpenFaceClip> clip = motion::ReadOpenFace(path);
  if (!clip.ok()) return clip.status();
  for (const std::string& note : clip->notes) notes_.push_back(path + ": " + note);
  // Lines over lost frames, and nothing else: the median is a step of the evaluation.
  const Result<motion::CleanReport> report = motion::Clean(&clip->track, {.median = 1});
  if (!report.ok()) return report.status().In(path);
  for (const std::string& note : report->notes) notes_.push_back(path + ": " + note);
  if (rate > 0 && std::abs(clip->track.frame_rate / rate - 1) > 1e-3) {
    notes_.push_back(path + ": resampled from " + Significant(clip->track.frame_rate, 4) + " to " +
                     Significant(rate, 4) + " frames per second");
    Result<motion::Track> resampled = motion::Resample(clip->track, rate);
    if (!resampled.ok()) return resampled.status().In(path);
    clip->track = *std::move(resampled);
  }
  Sequence sequence;
  sequence.recorded = true;
  const motion::Track& track = clip->track;
  sequence.motion.frame_rate = track.frame_rate;
  sequence.motion.frames = track.frames;
  for (std::int64_t point = 0; point < track.point_count(); ++point) {
    const std::string name = ChannelName(track.points[static_cast<std::size_t>(point)]);
    EvalChannel channel{name, name.starts_with("AU") ? "intensity 0 to 5" : "rad", {Stretch{}}};
    for (std::int64_t frame = 0; frame < track.frames; ++frame)
      channel.stretches[0].values.push_back(track.value(frame, 0, point));
    sequence.channels.push_back(std::move(channel));
  }
  return sequence;
}

// All joints and face points that were seen, made as the inputs of the network would be.
Result<Sequence> SequenceReader::ReadOpenPoseFolder(const std::string& path, double rate) {
  FeatureSpec spec;
  for (const ArrayLayout& layout : layouts_) {
    if (layout.spec.joints.empty()) continue;
    spec = layout.spec;
    break;
  }
  if (rate <= 0) rate = spec.frame_rate;
  features::Account account;
  const Result<features::Figure> figure = features::ReadFigure(path, pose_rate_, 0, rate, &account);
  if (!figure.ok()) return figure.status();
  for (const std::string& note : account.notes) notes_.push_back(path + ": " + note);
  Sequence sequence;
  sequence.motion.frame_rate = rate;
  sequence.motion.frames = figure->body.frames;
  spec.joints = Seen(figure->body);
  Result<models::Array> pose = features::PoseOf(*figure, spec);
  if (!pose.ok()) return pose.status().In(path);
  sequence.motion.body = FigureOf(spec.joints, motion::PatsJointNames(), *std::move(pose));
  spec.landmarks = Seen(figure->face);
  if (spec.landmarks.empty() || figure->face.frames == 0) return sequence;
  Result<models::Array> face = features::FaceOf(*figure, spec);
  if (!face.ok()) return face.status().In(path);
  sequence.motion.face = FigureOf(spec.landmarks, motion::FacePointNames(), *std::move(face));
  return sequence;
}

}  // namespace gestus::cli
