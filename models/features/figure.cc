#include "models/features/figure.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/motion/clean.h"
#include "models/motion/resample.h"

namespace gestus::features {
namespace {

constexpr double kUsualPoseRate = 15;

/// The frame rate of a video of `frames` frames that lasts as long as the recording: the usual one
/// that is nearest, if that is near at all.
double RateOf(std::int64_t frames, double seconds, Account* account) {
  constexpr double kUsual[] = {
      10, 12, 12.5, 15, 20, 24000.0 / 1001, 24, 25, 30000.0 / 1001, 30, 50, 60000.0 / 1001, 60};
  constexpr double kNear = 0.03;
  const double rate = static_cast<double>(frames) / seconds;
  const double nearest = *std::min_element(
      std::begin(kUsual), std::end(kUsual),
      [rate](double a, double b) { return std::abs(a - rate) < std::abs(b - rate); });
  const double taken =
      std::abs(nearest / rate - 1) < kNear ? nearest : std::clamp(rate, 1.0, 1000.0);
  account->notes.push_back("poses: taken for " + Significant(taken, 4) +
                           " frames per second, as the recording's length says");
  return taken;
}

/// Cleaned and at the motion's rate.
Result<motion::Track> Cleaned(motion::Track track, double rate, const std::string& what,
                              Account* account) {
  const Result<motion::CleanReport> report =
      motion::Clean(&track, {.order = motion::CleanOrder::kFillFirst});
  if (!report.ok()) return report.status().In(what);
  // Points that were never seen matter only when the network takes them, and then are an error.
  if (report->filled_points > 0)
    account->notes.push_back(
        what + ": " + Count(static_cast<std::uint64_t>(report->lost_frames), "frame") + " of " +
        std::to_string(track.frames) + " lost; points were filled in over " +
        Count(static_cast<std::uint64_t>(report->longest_gap), "frame") + " in a row at most");
  return motion::Resample(track, rate);
}

motion::PoseSource SourceOf(const FeatureSpec& spec) {
  return spec.pose_source == PoseSource::kData ? motion::PoseSource::kData
                                               : motion::PoseSource::kNormalize;
}

}  // namespace

models::Array RowsOf(std::vector<float> values, std::int64_t rows) {
  models::Array array;
  array.shape = {rows, static_cast<std::int64_t>(values.size()) / std::max<std::int64_t>(rows, 1)};
  array.f32 = std::move(values);
  return array;
}

Result<Figure> ReadFigure(const std::string& path, double pose_rate, double seconds,
                          double frame_rate, Account* account) {
  motion::OpenPoseOptions options;
  options.frame_rate = pose_rate > 0 ? pose_rate : kUsualPoseRate;
  Result<motion::OpenPoseClip> read = motion::ReadOpenPose(path, options);
  if (!read.ok()) return read.status();
  Figure figure;
  figure.raw = *std::move(read);
  account->notes.insert(account->notes.end(), figure.raw.notes.begin(), figure.raw.notes.end());
  if (pose_rate <= 0 && seconds > 0) {
    const double rate = RateOf(figure.raw.body.frames, seconds, account);
    figure.raw.body.frame_rate = figure.raw.face.frame_rate = rate;
  } else if (pose_rate <= 0) {
    account->notes.push_back("poses: taken for " + Significant(kUsualPoseRate, 4) +
                             " frames per second, which OpenPose's files do not say");
  }
  Result<motion::Track> body = Cleaned(figure.raw.body, frame_rate, "body", account);
  if (!body.ok()) return body.status().In(path);
  figure.body = *std::move(body);
  Result<motion::Stances> stances = motion::FindStances(figure.body);
  if (!stances.ok()) return stances.status().In(path);
  figure.stances = *std::move(stances);
  account->notes.insert(account->notes.end(), figure.stances.notes.begin(),
                        figure.stances.notes.end());
  if (figure.raw.face.frames == 0) return figure;
  Result<motion::Track> face = Cleaned(figure.raw.face, frame_rate, "face", account);
  if (!face.ok()) return face.status().In(path);
  figure.face = *std::move(face);
  return figure;
}

Result<models::Array> PoseOf(const Figure& figure, const FeatureSpec& spec) {
  motion::PoseLayout layout;
  layout.joints.assign(spec.joints.begin(), spec.joints.end());
  layout.source = SourceOf(spec);
  layout.neck =
      spec.neck == NeckColumns::kZero ? motion::NeckColumns::kZero : motion::NeckColumns::kPosition;
  if (layout.joints.empty())
    return Status(Code::kBadWeights,
                  "joints: the network lists none, expected the joints of a pose");
  Result<std::vector<float>> pose = motion::PoseColumns(figure.body, layout, figure.stances.frames);
  if (!pose.ok()) return pose.status();
  return RowsOf(*std::move(pose), figure.body.frames);
}

Result<models::Array> FaceOf(const Figure& figure, const FeatureSpec& spec) {
  if (spec.landmarks.empty())
    return Status(Code::kBadWeights,
                  "landmarks: the network lists none, expected the landmarks of a face");
  if (figure.face.frames == 0)
    return Status(Code::kBadInput,
                  "no face in any frame, expected the 70 points of OpenPose's --face");
  const std::vector<std::int32_t> landmarks(spec.landmarks.begin(), spec.landmarks.end());
  Result<std::vector<float>> face =
      motion::FaceColumns(figure.face, landmarks, SourceOf(spec), figure.stances.frames);
  if (!face.ok()) return face.status();
  return RowsOf(*std::move(face), figure.face.frames);
}

}  // namespace gestus::features
