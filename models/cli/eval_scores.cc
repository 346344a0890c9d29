// Evaluate: first what all sequences have in common, then each case, then all together.
#include "models/cli/eval_scores.h"

#include <algorithm>

#include "models/cli/eval_columns.h"
#include "models/io/text.h"
#include "models/metrics/error.h"
#include "models/metrics/points.h"
#include "models/motion/clean.h"

namespace gestus::cli {
namespace {

using metrics::Activity;
using metrics::Measure;
using Numbers = std::vector<std::int64_t>;

const Sequence& PredictionOf(const Case& one) { return *one.of[kPrediction]; }

/// All sequences that take part: those of the cases, and every source and target.
std::vector<const Sequence*> Taking(const Material& material, Role role) {
  std::vector<const Sequence*> taking;
  if (role == kSource || role == kTarget) {
    for (const Sequence& sequence : material.sequences[role]) taking.push_back(&sequence);
    return taking;
  }
  for (const Case& one : material.cases) {
    if (one.of[role] != nullptr) taking.push_back(one.of[role]);
  }
  return taking;
}

/// Points that every figure has; those of the first prediction that are not among them are noted.
Numbers SharedPoints(Material* material, metrics::Part part) {
  const auto figure_of = [part](const Sequence& s) {
    const auto& figure = part == metrics::Part::kBody ? s.motion.body : s.motion.face;
    return figure ? &*figure : nullptr;
  };
  std::vector<const outputs::Figure*> figures;
  for (const Role role : {kPrediction, kTruth, kSource, kTarget}) {
    for (const Sequence* sequence : Taking(*material, role))
      figures.push_back(figure_of(*sequence));
  }
  Numbers shared = metrics::SharedSources(figures, part);
  std::string lacking;
  if (const outputs::Figure* first = figure_of(PredictionOf(material->cases.front()))) {
    for (const outputs::Point& point : first->points) {
      if (part == metrics::Part::kBody && point.source == metrics::kNeck) continue;
      if (std::find(shared.begin(), shared.end(), point.source) == shared.end())
        lacking += (lacking.empty() ? "" : ", ") + point.name;
    }
  }
  if (!lacking.empty())
    material->notes.push_back("left out, because not all files have them: " + lacking);
  return shared;
}

std::vector<std::string> SharedChannels(Material* material) {
  std::vector<std::string> shared;
  std::string lacking;
  for (const EvalChannel& channel : PredictionOf(material->cases.front()).channels) {
    const bool everywhere =
        std::all_of(material->cases.begin(), material->cases.end(), [&](const Case& one) {
          return std::all_of(one.of.begin(), one.of.begin() + 2, [&](const Sequence* sequence) {
            return sequence == nullptr ||
                   std::any_of(sequence->channels.begin(), sequence->channels.end(),
                               [&](const EvalChannel& c) { return c.name == channel.name; });
          });
        });
    if (everywhere) {
      shared.push_back(channel.name);
    } else {
      lacking += (lacking.empty() ? "" : ", ") + channel.name;
    }
  }
  if (!lacking.empty())
    material->notes.push_back("left out, because not all files have them: " + lacking);
  return shared;
}

std::vector<float> Filtered(const std::vector<float>& values, int median) {
  std::vector<float> filtered(values.size());
  motion::MedianFilter(values.data(), static_cast<std::int64_t>(values.size()), median,
                       /*hold_ends=*/false, filtered.data());
  return filtered;
}

ChannelScore ScoreOf(const Column& column, int median) {
  ChannelScore score{.group = column.group,
                     .name = column.name,
                     .unit = column.unit,
                     .values = static_cast<std::int64_t>(column.truth.size()),
                     .rmse = {},
                     .pcc = {},
                     .activity = {}};
  const bool filter = IsCurve(column) && median > 1 && !column.truth.empty();
  const std::vector<float> predicted =
      filter ? Filtered(column.predicted, median) : column.predicted;
  const std::vector<float> truth = filter ? Filtered(column.truth, median) : column.truth;
  score.rmse = metrics::Rmse(predicted, truth);
  score.pcc = metrics::Pearson(predicted, truth);
  if (column.group == kActionUnits) score.activity = metrics::ActivityOf(predicted, truth);
  return score;
}

/// Means over what is defined.
class Mean {
 public:
  void Add(const Measure& measure) {
    if (!measure) return;
    sum_ += *measure;
    ++count_;
  }
  Measure Get() const { return metrics::Ratio(sum_, count_); }

 private:
  double sum_ = 0, count_ = 0;
};

GroupScore GroupOf(const std::string& group, const std::vector<ChannelScore>& channels) {
  GroupScore score{.group = group, .channels = 0, .rmse = {}, .pcc = {}, .activity = {}};
  Mean rmse, pcc, intensity, count, non_hit, values, states;
  for (const ChannelScore& channel : channels) {
    if (channel.group != group) continue;
    ++score.channels;
    rmse.Add(channel.rmse);
    pcc.Add(channel.pcc);
    intensity.Add(channel.activity.hit_intensity);
    count.Add(channel.activity.hit_count);
    non_hit.Add(channel.activity.non_hit);
    values.Add(channel.activity.accuracy_intensity);
    states.Add(channel.activity.accuracy_count);
  }
  score.rmse = rmse.Get();
  score.pcc = pcc.Get();
  score.activity = {.hit_intensity = intensity.Get(),
                    .hit_count = count.Get(),
                    .non_hit = non_hit.Get(),
                    .accuracy_intensity = values.Get(),
                    .accuracy_count = states.Get()};
  return score;
}

void AddChannelScores(const std::vector<Column>& columns, int median, Scores* scores) {
  for (const Column& column : columns) scores->channels.push_back(ScoreOf(column, median));
  for (const ChannelScore& channel : scores->channels) {
    if (std::none_of(scores->groups.begin(), scores->groups.end(),
                     [&](const GroupScore& group) { return group.group == channel.group; }))
      scores->groups.push_back(GroupOf(channel.group, scores->channels));
  }
}

/// The columns of one case behind those of the others.
void Append(std::vector<Column>&& from, std::vector<Column>* all) {
  for (Column& column : from) {
    const auto same = std::find_if(all->begin(), all->end(), [&](const Column& c) {
      return c.group == column.group && c.name == column.name;
    });
    if (same == all->end()) {
      all->push_back(std::move(column));
      continue;
    }
    same->predicted.insert(same->predicted.end(), column.predicted.begin(), column.predicted.end());
    same->truth.insert(same->truth.end(), column.truth.begin(), column.truth.end());
  }
}

template <class Sums>
void AddTo(const Sums& sums, std::optional<Sums>* total) {
  if (!*total) total->emplace();
  (*total)->Add(sums);
}

/// What is added up over cases.
class Pool {
 public:
  Pool(const ScoreOptions& options, Material* material)
      : options_(options),
        material_(material),
        joints_(SharedPoints(material, metrics::Part::kBody)),
        landmarks_(SharedPoints(material, metrics::Part::kFace)),
        channels_(SharedChannels(material)) {}

  Result<Scores> Score(const Case& one) {
    const Sequence& prediction = PredictionOf(one);
    Scores scores;
    scores.name = prediction.name;
    scores.frames = prediction.motion.frames;
    if (one.of[kTruth] != nullptr) GESTUS_RETURN_IF_ERROR(Compare(one, &scores));
    for (const Role role : {kPrediction, kTruth, kSource, kTarget}) {
      if (one.of[role] == nullptr) continue;
      if (const auto sums = BehaviourOf(*one.of[role])) scores.behaviour[role] = sums->Mean();
      if (role != kPrediction) AddDistances(one, role, &scores);
    }
    return scores;
  }

  Scores Whole() {
    Scores whole;
    AddChannelScores(columns_, options_.median, &whole);
    for (const Case& one : material_->cases) whole.frames += PredictionOf(one).motion.frames;
    for (const Role role : {kPrediction, kTruth, kSource, kTarget}) {
      std::optional<metrics::BehaviourSums> total;
      for (const Sequence* sequence : Taking(*material_, role)) {
        if (const auto sums = BehaviourOf(*sequence)) AddTo(*sums, &total);
      }
      if (total) whole.behaviour[role] = total->Mean();
    }
    whole.content = content_;
    whole.distances = distances_;
    return whole;
  }

  const Numbers& joints() const { return joints_; }
  const Numbers& landmarks() const { return landmarks_; }

 private:
  Status Compare(const Case& one, Scores* scores) {
    const Sequence &prediction = PredictionOf(one), &truth = *one.of[kTruth];
    Result<std::vector<Column>> columns =
        CurveColumns(prediction, truth, channels_, &material_->notes);
    if (!columns.ok()) return columns.status();
    for (Column& column : PointColumns(prediction, truth, joints_, landmarks_))
      columns->push_back(std::move(column));
    AddChannelScores(*columns, options_.median, scores);
    Append(*std::move(columns), &columns_);
    return Status();
  }

  std::optional<metrics::BehaviourSums> BehaviourOf(const Sequence& sequence) const {
    if (!sequence.motion.body || joints_.empty()) return std::nullopt;
    return metrics::SumBehaviour(*sequence.motion.body, sequence.motion.frames,
                                 sequence.motion.frame_rate, joints_);
  }

  void AddDistances(const Case& one, Role role, Scores* scores) {
    const outputs::Motion &a = PredictionOf(one).motion, &b = one.of[role]->motion;
    const bool body = a.body && b.body, face = a.face && b.face;
    const Numbers joints = body ? joints_ : Numbers(), landmarks = face ? landmarks_ : Numbers();
    const auto points = static_cast<std::int64_t>(joints.size() + landmarks.size());
    if (points == 0) return;
    const std::int64_t frames = std::min(a.frames, b.frames);
    if (a.frames != b.frames)
      material_->notes.push_back(PredictionOf(one).path + ": has " +
                                 Count(static_cast<std::uint64_t>(a.frames), "frame") + ", its " +
                                 kRoleNames[role] + " " + std::to_string(b.frames) +
                                 "; the first " + std::to_string(frames) + " were compared");
    const auto predicted = metrics::Coordinates(a, frames, joints, landmarks);
    const auto other = metrics::Coordinates(b, frames, joints, landmarks);
    const auto distances = metrics::SumDistances(predicted, other, points, options_.order);
    scores->distances[role] = distances;
    AddTo(distances, &distances_[role]);
    if (role != kSource) return;
    const auto content = metrics::SumContent(other, predicted);
    scores->content = content;
    AddTo(content, &content_);
  }

  ScoreOptions options_;
  Material* material_;
  Numbers joints_, landmarks_;
  std::vector<std::string> channels_;
  std::vector<Column> columns_;
  std::optional<metrics::ContentSums> content_;
  std::array<std::optional<metrics::DistanceSums>, kRoles> distances_;
};

}  // namespace

metrics::StyleDistance Scores::ToTarget(std::size_t index) const {
  const auto of = [&](Role role) {
    return behaviour[role] ? (*behaviour[role])[index] : Measure();
  };
  return metrics::DistanceToTarget(of(kSource), of(kPrediction), of(kTarget));
}

Result<Evaluation> Evaluate(const ScoreOptions& options, Material* material) {
  Evaluation evaluation;
  Pool pool(options, material);
  Mean content;
  for (const Case& one : material->cases) {
    Result<Scores> scores = pool.Score(one);
    if (!scores.ok()) return scores.status();
    if (scores->content) content.Add(scores->content->Percent());
    evaluation.sequences.push_back(*std::move(scores));
  }
  evaluation.pooled = pool.Whole();
  evaluation.content_mean = content.Get();
  evaluation.joints = pool.joints();
  evaluation.landmarks = pool.landmarks();
  const Scores& whole = evaluation.pooled;
  const bool distances = std::any_of(whole.distances.begin(), whole.distances.end(),
                                     [](const auto& d) { return d.has_value(); });
  if (whole.channels.empty() && !whole.behaviour[kPrediction] && !distances) {
    const Sequence& prediction = PredictionOf(material->cases.front());
    return Status(Code::kBadInput,
                  prediction.path +
                      ": nothing to compare, expected a truth with the same joints, "
                      "face points, action units or angles");
  }
  return evaluation;
}

}  // namespace gestus::cli
