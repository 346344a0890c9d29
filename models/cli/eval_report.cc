// The figures in a row, and CSV and JSON of them.
#include "models/cli/eval_report.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "models/cli/eval_columns.h"
#include "models/cli/json.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using metrics::Activity;
using metrics::Measure;

// null in JSON
double Number(const Measure& measure) {
  return measure.value_or(std::numeric_limits<double>::quiet_NaN());
}

template <class Score>
void AddScore(const Score& score, const std::string& subject, const std::string& unit,
              std::vector<Figured>* figures) {
  figures->push_back({score.group, subject, "rmse", score.rmse, unit});
  figures->push_back({score.group, subject, "pcc", score.pcc, ""});
  if (score.group != kActionUnits) return;
  const Activity& a = score.activity;
  figures->push_back({score.group, subject, "ahr_intensity", a.hit_intensity, "%"});
  figures->push_back({score.group, subject, "ahr_count", a.hit_count, "%"});
  figures->push_back({score.group, subject, "nahr", a.non_hit, "%"});
  figures->push_back({score.group, subject, "accuracy_intensity", a.accuracy_intensity, "%"});
  figures->push_back({score.group, subject, "accuracy_count", a.accuracy_count, "%"});
}

bool HasDistances(const Scores& scores) {
  return scores.behaviour[kTarget] && (scores.behaviour[kSource] || scores.behaviour[kPrediction]);
}

void AddBehaviour(const Scores& scores, std::vector<Figured>* figures) {
  for (std::size_t i = 0; i < metrics::kBehaviours; ++i) {
    const auto& [id, label, unit] = metrics::kBehaviourNames[i];
    for (std::size_t role = 0; role < kRoles; ++role) {
      if (scores.behaviour[role])
        figures->push_back({"behaviour", kRoleNames[role], id, (*scores.behaviour[role])[i], unit});
    }
    if (!HasDistances(scores)) continue;
    const metrics::StyleDistance to = scores.ToTarget(i);
    figures->push_back({"dist", "source", id, to.source, unit});
    figures->push_back({"dist", "prediction", id, to.prediction, unit});
    figures->push_back({"dist_avg", "source", id, to.source_percent, "%"});
    figures->push_back({"dist_avg", "prediction", id, to.prediction_percent, "%"});
  }
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string CsvNumber(const Measure& measure) {
  if (!measure) return "";
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), *measure).ptr;
  return std::string(buffer.data(), end);
}

void AddCsv(const Scores& scores, std::vector<Figured> figures, std::string* csv) {
  const std::string name = scores.name.empty() ? "all" : scores.name;
  for (const Figured& figured : figures)
    *csv += CsvField(OneLine(name)) + "," + figured.group + "," + CsvField(figured.subject) + "," +
            figured.measure + "," + CsvNumber(figured.value) + "," + figured.unit + "\n";
}

template <class Score>
void ScoreJson(JsonWriter* json, const Score& score) {
  json->Member("rmse", Number(score.rmse)).Member("pcc", Number(score.pcc));
  if (score.group != kActionUnits) return;
  const Activity& a = score.activity;
  json->Member("ahr_intensity", Number(a.hit_intensity))
      .Member("ahr_count", Number(a.hit_count))
      .Member("nahr", Number(a.non_hit))
      .Member("accuracy_intensity", Number(a.accuracy_intensity))
      .Member("accuracy_count", Number(a.accuracy_count));
}

void BehaviourJson(JsonWriter* json, const Scores& scores) {
  json->Key("behaviour").BeginObject();
  for (std::size_t i = 0; i < metrics::kBehaviours; ++i) {
    json->Key(metrics::kBehaviourNames[i].id).BeginObject();
    json->Member("unit", metrics::kBehaviourNames[i].unit);
    for (std::size_t role = 0; role < kRoles; ++role) {
      if (scores.behaviour[role])
        json->Member(kRoleNames[role], Number((*scores.behaviour[role])[i]));
    }
    if (HasDistances(scores)) {
      const metrics::StyleDistance to = scores.ToTarget(i);
      json->Member("dist_source", Number(to.source))
          .Member("dist_prediction", Number(to.prediction))
          .Member("dist_avg_source", Number(to.source_percent))
          .Member("dist_avg_prediction", Number(to.prediction_percent));
    }
    json->EndObject();
  }
  json->EndObject();
}

void MotionJson(JsonWriter* json, const Scores& scores) {
  if (scores.behaviour[kPrediction]) BehaviourJson(json, scores);
  if (scores.content) json->Member("content_preservation", Number(scores.content->Percent()));
  json->Key("minkowski").BeginObject();
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!scores.distances[role]) continue;
    json->Key(kRoleNames[role])
        .BeginObject()
        .Member("per_point", Number(scores.distances[role]->PerPoint()))
        .Member("per_frame", Number(scores.distances[role]->PerFrame()))
        .EndObject();
  }
  json->EndObject();
  if (!scores.transfer[kPrediction]) return;
  json->Key("transfer").BeginObject();
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!scores.transfer[role]) continue;
    json->Key(kRoleNames[role])
        .BeginObject()
        .Member("taken_for_target", scores.transfer[role]->right)
        .Member("pieces", scores.transfer[role]->total)
        .Member("percent", Number(scores.transfer[role]->Percent()))
        .EndObject();
  }
  json->EndObject();
}

void ScoresJson(JsonWriter* json, const Scores& scores) {
  json->BeginObject();
  if (!scores.name.empty()) json->Member("name", scores.name);
  json->Member("frames", scores.frames).Key("channels").BeginArray();
  for (const ChannelScore& channel : scores.channels) {
    json->BeginObject()
        .Member("group", channel.group)
        .Member("name", channel.name)
        .Member("unit", channel.unit)
        .Member("values", channel.values);
    ScoreJson(json, channel);
    json->EndObject();
  }
  json->EndArray().Key("means").BeginArray();
  for (const GroupScore& group : scores.groups) {
    json->BeginObject().Member("group", group.group).Member("channels", group.channels);
    ScoreJson(json, group);
    json->EndObject();
  }
  json->EndArray();
  MotionJson(json, scores);
  json->EndObject();
}

}  // namespace

std::optional<EvalFormat> FormatOf(const std::string& path) {
  if (path.ends_with(".txt")) return EvalFormat::kText;
  if (path.ends_with(".csv")) return EvalFormat::kCsv;
  if (path.ends_with(".json")) return EvalFormat::kJson;
  if (path.ends_with(".html")) return EvalFormat::kHtml;
  return std::nullopt;
}

std::string MeasureText(const Measure& measure) {
  constexpr int kDigits = 4;
  return measure ? Significant(*measure, kDigits) : "undefined";
}

std::vector<Figured> FiguresOf(const Scores& scores) {
  std::vector<Figured> figures;
  for (const ChannelScore& channel : scores.channels)
    AddScore(channel, channel.name, channel.unit, &figures);
  for (const GroupScore& group : scores.groups) AddScore(group, "mean", "", &figures);
  AddBehaviour(scores, &figures);
  if (scores.content)
    figures.push_back(
        {"content", "prediction", "content_preservation", scores.content->Percent(), "%"});
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!scores.distances[role]) continue;
    const metrics::DistanceSums& d = *scores.distances[role];
    figures.push_back({"minkowski", kRoleNames[role], "per_point", d.PerPoint(), "units"});
    figures.push_back({"minkowski", kRoleNames[role], "per_frame", d.PerFrame(), "units"});
  }
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (scores.transfer[role])
      figures.push_back({"transfer", kRoleNames[role],
                         role == kPrediction ? "transfer_strength" : "taken_for_target",
                         scores.transfer[role]->Percent(), "%"});
  }
  return figures;
}

std::string EvalReport::In(EvalFormat format) const {
  switch (format) {
    case EvalFormat::kCsv:
      return Csv();
    case EvalFormat::kJson:
      return Json();
    case EvalFormat::kHtml:
      return Html();
    default:
      return Text();
  }
}

std::string EvalReport::Csv() const {
  std::string csv = "sequence,group,subject,measure,value,unit\n";
  std::vector<Figured> all = FiguresOf(evaluation.pooled);
  if (evaluation.pooled.content)
    all.push_back(
        {"content", "prediction", "content_preservation_mean", evaluation.content_mean, "%"});
  AddCsv(evaluation.pooled, std::move(all), &csv);
  for (const Scores& scores : evaluation.sequences) AddCsv(scores, FiguresOf(scores), &csv);
  return csv;
}

std::string EvalReport::Json() const {
  const EvalOptions& eval = arguments.eval;
  JsonWriter json;
  json.BeginObject().Member("predictions", eval.predictions);
  for (const auto& [key, path] : {std::pair{"truth", &eval.truth},
                                  {"source", &eval.source},
                                  {"target", &eval.target},
                                  {"weights", &arguments.weights}}) {
    if (!path->empty()) json.Member(key, *path);
  }
  if (!classifier.empty()) json.Member("classifier", classifier).Member("trained", trained);
  json.Member("frame_rate", material.sequences[kPrediction].front().motion.frame_rate)
      .Member("median", eval.median)
      .Member("minkowski_order", eval.order)
      .Member("active_above", double{metrics::kActive})
      .Member("notes", material.notes);
  json.Key("all");
  ScoresJson(&json, evaluation.pooled);
  if (evaluation.pooled.content)
    json.Member("content_preservation_mean", Number(evaluation.content_mean));
  json.Key("sequences").BeginArray();
  for (const Scores& scores : evaluation.sequences) ScoresJson(&json, scores);
  json.EndArray().EndObject();
  return json.text();
}

}  // namespace gestus::cli
