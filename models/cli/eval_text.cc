// EvalReport::Text: tables for a terminal.
#include <algorithm>

#include "models/cli/eval_columns.h"
#include "models/cli/eval_report.h"
#include "models/cli/setup.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostSequences = 40, kMostNotes = 20;

std::string Aligned(const Rows& rows) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 1; i < rows.front().size(); ++i) numbers.push_back(i);
  return Table(rows, numbers);
}

template <class Score>
std::vector<std::string> ActivityRow(const std::string& name, const Score& score, bool units) {
  std::vector<std::string> row = {name, MeasureText(score.rmse), MeasureText(score.pcc)};
  if (!units) return row;
  const metrics::Activity& a = score.activity;
  const bool asked = score.group == kActionUnits;
  for (const metrics::Measure* measure :
       {&a.hit_intensity, &a.hit_count, &a.non_hit, &a.accuracy_intensity, &a.accuracy_count})
    row.push_back(asked ? MeasureText(*measure) : "-");
  return row;
}

/// Curves one by one; of points, which are many, the means.
std::string ErrorText(const Scores& scores) {
  if (scores.channels.empty()) return "";
  const bool units =
      std::any_of(scores.groups.begin(), scores.groups.end(),
                  [](const GroupScore& group) { return group.group == kActionUnits; });
  Rows rows = {{"", "RMSE", "PCC"}};
  if (units)
    rows[0].insert(rows[0].end(),
                   {"AHR sum %", "AHR count %", "NAHR %", "accuracy values %", "accuracy %"});
  for (const GroupScore& group : scores.groups) {
    const bool points = group.group == "body" || group.group == "face";
    for (const ChannelScore& channel : scores.channels) {
      if (channel.group == group.group && !points)
        rows.push_back(ActivityRow(channel.name, channel, units));
    }
    rows.push_back(
        ActivityRow(group.group + ", mean of " + std::to_string(group.channels), group, units));
  }
  return "\nprediction and truth\n" + Aligned(rows);
}

std::string BehaviourText(const Scores& scores) {
  if (!scores.behaviour[kPrediction]) return "";
  const bool target = scores.behaviour[kTarget].has_value();
  Rows rows = {{"", "unit"}};
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (scores.behaviour[role]) rows[0].push_back(kRoleNames[role]);
  }
  if (target) rows[0].insert(rows[0].end(), {"source to target %", "prediction to target %"});
  for (std::size_t i = 0; i < metrics::kBehaviours; ++i) {
    std::vector<std::string> row = {metrics::kBehaviourNames[i].label,
                                    metrics::kBehaviourNames[i].unit};
    for (std::size_t role = 0; role < kRoles; ++role) {
      if (scores.behaviour[role]) row.push_back(MeasureText((*scores.behaviour[role])[i]));
    }
    const metrics::StyleDistance to = scores.ToTarget(i);
    if (target)
      row.insert(row.end(), {MeasureText(to.source_percent), MeasureText(to.prediction_percent)});
    rows.push_back(std::move(row));
  }
  return "\nbehaviour" + std::string(target ? ", and Dist_avg of equation 6.9" : "") + "\n" +
         Aligned(rows);
}

std::string StyleText(const EvalReport& report) {
  const Scores& all = report.evaluation.pooled;
  Rows rows;
  if (all.content) {
    rows.push_back({"content preservation", MeasureText(all.content->Percent()) + " %",
                    "of all frames as one vector"});
    rows.push_back(
        {"", MeasureText(report.evaluation.content_mean) + " %", "mean of the sequences"});
  }
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!all.distances[role]) continue;
    rows.push_back({std::string("distance to ") + kRoleNames[role],
                    MeasureText(all.distances[role]->PerPoint()) + " units", "a point"});
    rows.push_back({"", MeasureText(all.distances[role]->PerFrame()) + " units", "a frame"});
  }
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!all.transfer[role]) continue;
    const metrics::TransferStrength& t = *all.transfer[role];
    rows.push_back({role == kPrediction ? "transfer strength"
                                        : std::string(kRoleNames[role]) + " taken for the target",
                    MeasureText(t.Percent()) + " %",
                    std::to_string(t.right) + " of " + std::to_string(t.total) + " pieces, by " +
                        report.classifier});
  }
  return rows.empty() ? "" : "\nstyle and content\n" + Table(rows, {1});
}

std::string SequencesText(const Evaluation& evaluation) {
  if (evaluation.sequences.size() < 2) return "";
  Rows rows = {{"sequence", "frames"}};
  for (const GroupScore& group : evaluation.pooled.groups) {
    rows[0].push_back(group.group + " RMSE");
    rows[0].push_back("PCC");
  }
  if (evaluation.pooled.content) rows[0].push_back("content %");
  for (const Scores& scores : evaluation.sequences) {
    if (rows.size() > kMostSequences) break;
    std::vector<std::string> row = {OneLine(scores.name, 40), std::to_string(scores.frames)};
    for (const GroupScore& group : evaluation.pooled.groups) {
      const GroupScore* own = nullptr;
      for (const GroupScore& g : scores.groups) own = g.group == group.group ? &g : own;
      row.push_back(own == nullptr ? "-" : MeasureText(own->rmse));
      row.push_back(own == nullptr ? "-" : MeasureText(own->pcc));
    }
    if (evaluation.pooled.content)
      row.push_back(scores.content ? MeasureText(scores.content->Percent()) : "-");
    rows.push_back(std::move(row));
  }
  std::string text = "\none by one\n" + Aligned(rows);
  if (evaluation.sequences.size() > kMostSequences)
    text += "  and " + Count(evaluation.sequences.size() - kMostSequences, "sequence") +
            " more: -o FILE.csv has them\n";
  return text;
}

}  // namespace

std::string EvalReport::Text() const {
  const EvalOptions& eval = arguments.eval;
  std::string text;
  for (const auto& [role, path] : {std::pair{kPrediction, &eval.predictions},
                                   {kTruth, &eval.truth},
                                   {kSource, &eval.source},
                                   {kTarget, &eval.target}}) {
    if (path->empty()) continue;
    const std::string name = role == kPrediction ? "predictions" : kRoleNames[role];
    text += name + std::string(13 - name.size(), ' ') + OneLine(*path, 120) + ": " +
            Count(material.sequences[role].size(), "sequence") + "\n";
  }
  text += "compared     " + Count(evaluation.sequences.size(), "sequence") + ", " +
          Count(static_cast<std::uint64_t>(evaluation.pooled.frames), "frame") + " at " +
          Significant(material.sequences[kPrediction].front().motion.frame_rate, 4) +
          " per second\n";
  text += ErrorText(evaluation.pooled) + BehaviourText(evaluation.pooled) + StyleText(*this) +
          SequencesText(evaluation);
  if (!material.notes.empty() || !trained || !arguments.output.empty()) text += "\n";
  for (std::size_t i = 0; i < std::min(kMostNotes, material.notes.size()); ++i)
    text += "note: " + OneLine(material.notes[i]) + "\n";
  if (material.notes.size() > kMostNotes)
    text += "note: and " + std::to_string(material.notes.size() - kMostNotes) +
            " more; --json has them\n";
  if (!trained && !classifier.empty())
    text += std::string("warning: ") + kUntrained + ", and so is the transfer strength\n";
  if (!arguments.output.empty()) text += "wrote " + arguments.output + "\n";
  return text;
}

}  // namespace gestus::cli
