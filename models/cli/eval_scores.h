// From sequences to scores: who is compared with whom, and the measures of models/metrics on them.
#ifndef GESTUS_MODELS_CLI_EVAL_SCORES_H_
#define GESTUS_MODELS_CLI_EVAL_SCORES_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/cli/eval_sequences.h"
#include "models/metrics/activity.h"
#include "models/metrics/behaviour.h"
#include "models/metrics/measure.h"
#include "models/metrics/similarity.h"
#include "models/metrics/transfer.h"

namespace gestus::cli {

enum Role : std::size_t { kPrediction, kTruth, kSource, kTarget, kRoles };
constexpr std::array<const char*, kRoles> kRoleNames = {"prediction", "truth", "source", "target"};

/// One predicted sequence and its partners; null where there is none.
struct Case {
  std::array<const Sequence*, kRoles> of{};
};

/// Everything that is evaluated.
struct Material {
  std::array<std::vector<Sequence>, kRoles> sequences;
  std::vector<Case> cases;  ///< one for each prediction that has a truth, if truths are given
  std::vector<std::string> notes;
};

/// Pairs the sequences by their names: a truth with each prediction (one of each are a pair
/// whatever their names), a source and a target where there is one; a single file of source or
/// target serves every prediction.  Predictions and truths without partner are noted and left out;
/// it is an error when none has one.
Status PairSequences(const std::array<bool, kRoles>& folders, Material* material);

/// What one column of numbers is compared by.
struct ChannelScore {
  std::string group;  ///< "action units", "head", "body", "face"
  std::string name;   ///< "AU01", "RWrist x"
  std::string unit;
  std::int64_t values = 0;
  metrics::Measure rmse, pcc;
  metrics::Activity activity;  ///< of action units
};

/// Means over the channels of a group for which the measure is defined.
struct GroupScore {
  std::string group;
  std::int64_t channels = 0;
  metrics::Measure rmse, pcc;
  metrics::Activity activity;
};

struct Scores {
  std::string name;         ///< of the sequence; empty: all of them
  std::int64_t frames = 0;  ///< of the prediction
  std::vector<ChannelScore> channels;
  std::vector<GroupScore> groups;
  std::array<std::optional<metrics::Behaviour>, kRoles> behaviour;
  std::optional<metrics::ContentSums> content;                         ///< of source and prediction
  std::array<std::optional<metrics::DistanceSums>, kRoles> distances;  ///< to the prediction
  std::array<std::optional<metrics::TransferStrength>, kRoles> transfer;

  metrics::StyleDistance ToTarget(std::size_t behaviour_index) const;
};

struct ScoreOptions {
  int median = 7;    ///< frames, odd; 1: none
  double order = 2;  ///< of Minkowski distances
};

struct Evaluation {
  Scores pooled;
  std::vector<Scores> sequences;                ///< one for each case
  metrics::Measure content_mean;                ///< of the sequences' content preservation
  std::vector<std::int64_t> joints, landmarks;  ///< sources that all figures have
};

/// Adds notes to `material`.  An error when nothing of the predictions can be compared.
Result<Evaluation> Evaluate(const ScoreOptions& options, Material* material);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_SCORES_H_
