// EvalReport::Html: one file with everything in it, plots like the thesis' figures and the tables.
#include <algorithm>

#include "models/cli/eval_columns.h"
#include "models/cli/eval_report.h"
#include "models/cli/eval_svg.h"
#include "models/cli/setup.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using metrics::Measure;

constexpr double kShownSeconds = 40;

constexpr const char* kPageHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Evaluation of motion</title>
<style>
:root{color-scheme:light dark;--page:#fff;--ink:#1b1f24;--soft:#5b6570;--rule:#d9dee4;
--prediction:#2563c9;--truth:#15803d;--source:#b45309;--target:#8b3fc7}
@media (prefers-color-scheme:dark){:root:not([data-theme=light]){--page:#14171b;--ink:#e8ebef;
--soft:#a0a9b4;--rule:#343b44;--prediction:#7fb0ff;--truth:#5fd08a;--source:#f0a35e;--target:#cfa2ff}}
:root[data-theme=dark]{color-scheme:dark;--page:#14171b;--ink:#e8ebef;--soft:#a0a9b4;--rule:#343b44;
--prediction:#7fb0ff;--truth:#5fd08a;--source:#f0a35e;--target:#cfa2ff}
:root[data-theme=light]{color-scheme:light}
*{box-sizing:border-box}
body{margin:0 auto;max-width:60rem;padding:1rem;background:var(--page);color:var(--ink);
font:16px/1.5 system-ui,sans-serif}
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2.5rem;border-bottom:1px solid var(--rule)}
button{float:right;font:inherit;color:inherit;background:none;border:1px solid var(--rule);
border-radius:.4rem;padding:.2rem .6rem;cursor:pointer}
figure{margin:1.2rem 0;overflow-x:auto}figcaption{font-weight:600}
svg{width:100%;min-width:34rem;height:auto;display:block;font:12px system-ui,sans-serif}
svg text{fill:var(--soft)}svg .grid{stroke:var(--rule)}svg .axis{stroke:var(--soft)}
svg .line{stroke:var(--ink);stroke-dasharray:6 4}
.prediction{fill:var(--prediction);stroke:var(--prediction);background:var(--prediction)}
.truth{fill:var(--truth);stroke:var(--truth);background:var(--truth)}
.source{fill:var(--source);stroke:var(--source);background:var(--source)}
.target{fill:var(--target);stroke:var(--target);background:var(--target)}
svg rect{stroke:none}svg polyline{fill:none!important;stroke-width:1.6}svg polyline.truth{stroke-dasharray:5 3}
.legend{margin:.2rem 0;color:var(--soft);font-size:.9rem}.legend span{margin-right:1.2rem}
.legend i{display:inline-block;width:.8rem;height:.8rem;border-radius:.2rem;margin-right:.35rem}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.9rem;width:100%}
th,td{text-align:left;padding:.25rem .6rem;border-bottom:1px solid var(--rule);white-space:nowrap}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
summary{cursor:pointer;padding:.3rem 0}
.note{color:var(--soft)}.warning{color:var(--source);font-weight:600}
</style></head><body>
<button type="button" onclick="const r=document.documentElement,
d=r.dataset.theme||(matchMedia('(prefers-color-scheme:dark)').matches?'dark':'light');
r.dataset.theme=d==='dark'?'light':'dark'">Dark / light</button>
)";

/// Bars of a channel measure, one for each channel of the groups that `wanted` names.
template <class Get>
Bars ChannelBars(const std::vector<ChannelScore>& channels, const std::string& name,
                 const std::string& color, Get get) {
  Bars bars{name, color, {}};
  for (const ChannelScore& channel : channels) bars.values.push_back(get(channel));
  return bars;
}

std::vector<ChannelScore> Curves(const Scores& scores, bool only_units) {
  std::vector<ChannelScore> curves;
  for (const ChannelScore& channel : scores.channels) {
    const bool points = channel.group == "body" || channel.group == "face";
    if (!points && (!only_units || channel.group == kActionUnits)) curves.push_back(channel);
  }
  return curves;
}

std::vector<std::string> NamesOf(const std::vector<ChannelScore>& channels) {
  std::vector<std::string> names;
  for (const ChannelScore& channel : channels) names.push_back(channel.name);
  return names;
}

std::string CurveCharts(const Scores& all) {
  const std::vector<ChannelScore> curves = Curves(all, false), units = Curves(all, true);
  if (curves.empty()) return "";
  std::string html = "<h2>Predicted and true curves</h2>\n";
  html += BarChart(
      "Root mean squared error (as in Tables 5.5 and 5.8)", "intensity or rad", NamesOf(curves),
      {ChannelBars(curves, "RMSE", "prediction", [](const auto& c) { return c.rmse; })});
  html += BarChart("Pearson's correlation", "", NamesOf(curves),
                   {ChannelBars(curves, "PCC", "prediction", [](const auto& c) { return c.pcc; })},
                   1.0);
  if (units.empty()) return html;
  return html +
         BarChart(
             "Activity and non-activity hit ratios; the dashed line is as much as in the truth",
             "%", NamesOf(units),
             {ChannelBars(units, "AHR by intensity", "prediction",
                          [](const auto& c) { return c.activity.hit_intensity; }),
              ChannelBars(units, "AHR by count", "source",
                          [](const auto& c) { return c.activity.hit_count; }),
              ChannelBars(units, "NAHR", "target",
                          [](const auto& c) { return c.activity.non_hit; })},
             100.0);
}

std::vector<std::string> BehaviourLabels() {
  std::vector<std::string> labels;
  for (const auto& name : metrics::kBehaviourNames) labels.push_back(name.label);
  return labels;
}

/// Figures 6.4 and 6.5.
std::string DistanceChart(const Scores& all) {
  if (!all.behaviour[kSource] || !all.behaviour[kTarget] || !all.behaviour[kPrediction]) return "";
  Bars source{"Dist. (source, target)", "source", {}};
  Bars prediction{"Dist. (prediction, target)", "prediction", {}};
  for (std::size_t i = 0; i < metrics::kBehaviours; ++i) {
    source.values.push_back(all.ToTarget(i).source_percent);
    prediction.values.push_back(all.ToTarget(i).prediction_percent);
  }
  return "<h2>How far from the target's style</h2>\n" +
         BarChart(
             "Distances to the target speaker's style, in percent of both together "
             "(equation 6.9, as in Figures 6.4 and 6.5)",
             "%", BehaviourLabels(), {source, prediction}, 50.0) +
         "<p class=\"note\">On the dashed line both are as far from the target. A prediction that "
         "has "
         "taken on the target's style is far below it.</p>\n";
}

/// Every role in percent of the largest, because units differ.
std::string BehaviourChart(const Scores& all) {
  std::vector<Bars> bars;
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!all.behaviour[role]) continue;
    Bars one{kRoleNames[role], kRoleNames[role], {}};
    for (std::size_t i = 0; i < metrics::kBehaviours; ++i) {
      double largest = 0;
      for (const auto& behaviour : all.behaviour)
        largest = std::max(largest, behaviour ? (*behaviour)[i].value_or(0) : 0);
      const Measure& own = (*all.behaviour[role])[i];
      one.values.push_back(own ? metrics::Ratio(100 * *own, largest) : own);
    }
    bars.push_back(std::move(one));
  }
  if (bars.empty()) return "";
  return "<h2>Behaviour</h2>\n" + BarChart(
                                      "Behaviour expressivity, in percent of the liveliest "
                                      "(as in Figure 4.14)",
                                      "%", BehaviourLabels(), bars);
}

std::size_t Shown(double rate) { return static_cast<std::size_t>(kShownSeconds * rate); }

template <class T>
std::vector<double> Cut(const std::vector<T>& values, double rate) {
  const auto n = static_cast<std::ptrdiff_t>(std::min(values.size(), Shown(rate)));
  return std::vector<double>(values.begin(), values.begin() + n);
}

/// Curves of the first sequence over each other.
std::string Overlays(const EvalReport& report) {
  const Case& first = report.material.cases.front();
  const double rate = first.of[kPrediction]->motion.frame_rate;
  std::string html;
  std::vector<Line> speed;
  for (std::size_t role = 0; role < kRoles; ++role) {
    const Sequence* sequence = first.of[role];
    if (sequence == nullptr || !sequence->motion.body) continue;
    const outputs::Motion& motion = sequence->motion;
    speed.push_back({kRoleNames[role], kRoleNames[role],
                     Cut(metrics::WristSpeed(*motion.body, motion.frames, rate), rate)});
  }
  if (!speed.empty()) html += LineChart("Speed of the wrists", "units/s", rate, speed);
  if (first.of[kTruth] != nullptr) {
    std::vector<std::string> names, notes;
    for (const ChannelScore& channel : Curves(report.evaluation.sequences.front(), false))
      names.push_back(channel.name);
    const auto columns = CurveColumns(*first.of[kPrediction], *first.of[kTruth], names, &notes);
    for (const Column& column : columns.ok() ? *columns : std::vector<Column>())
      html += LineChart(column.name, column.unit, rate,
                        {{"truth", "truth", Cut(column.truth, rate)},
                         {"prediction", "prediction", Cut(column.predicted, rate)}});
  }
  if (html.empty()) return "";
  return "<h2>" + Escaped(first.of[kPrediction]->name) + " over time</h2>\n<p class=\"note\">The " +
         "first " + Fixed(kShownSeconds, 0) +
         " seconds at most, of the values that were compared, before the median filter.</p>\n" +
         html;
}

std::string FiguresTable(const Scores& scores) {
  std::string html =
      "<div class=\"scroll\"><table><tr><th>group<th>of<th>measure<th class=\"n\">value<th>unit"
      "</tr>\n";
  for (const Figured& figured : FiguresOf(scores))
    html += "<tr><td>" + Escaped(figured.group) + "<td>" + Escaped(figured.subject) + "<td>" +
            figured.measure + "<td class=\"n\">" + MeasureText(figured.value) + "<td>" +
            Escaped(figured.unit) + "</tr>\n";
  return html + "</table></div>\n";
}

std::string Summary(const EvalReport& report) {
  std::string html = "<h1>Evaluation of motion</h1>\n<div class=\"scroll\"><table>\n";
  const EvalOptions& eval = report.arguments.eval;
  const auto row = [&](const std::string& name, const std::string& value) {
    html += "<tr><td>" + name + "<td>" + Escaped(value) + "</tr>\n";
  };
  for (const auto& [name, path] : {std::pair{"predictions", &eval.predictions},
                                   {"truth", &eval.truth},
                                   {"source", &eval.source},
                                   {"target", &eval.target}}) {
    if (!path->empty()) row(name, *path);
  }
  const Scores& all = report.evaluation.pooled;
  row("compared", Count(report.evaluation.sequences.size(), "sequence") + ", " +
                      Count(static_cast<std::uint64_t>(all.frames), "frame"));
  if (all.content) row("content preservation", MeasureText(all.content->Percent()) + " %");
  if (all.transfer[kPrediction])
    row("transfer strength",
        MeasureText(all.transfer[kPrediction]->Percent()) + " %, by " + report.classifier);
  html += "</table></div>\n";
  if (!report.trained && !report.classifier.empty())
    html += std::string("<p class=\"warning\">") + kUntrained +
            ", and so is the transfer strength" + "</p>\n";
  if (report.material.notes.empty()) return html;
  html += "<details open><summary>Notes</summary><ul class=\"note\">\n";
  for (const std::string& note : report.material.notes) html += "<li>" + Escaped(note) + "</li>\n";
  return html + "</ul></details>\n";
}

}  // namespace

std::string EvalReport::Html() const {
  const Scores& all = evaluation.pooled;
  std::string html = kPageHead + Summary(*this) + DistanceChart(all) + BehaviourChart(all) +
                     CurveCharts(all) + Overlays(*this);
  const std::size_t rows = FiguresOf(all).size();
  constexpr std::size_t kMostRows = 60;  // more are shown when one asks for them
  html += "<h2>All figures</h2>\n<p class=\"note\">Median of " +
          std::to_string(arguments.eval.median) + " over curves, Minkowski distances of order " +
          Fixed(arguments.eval.order, 1) + ", action units active above 0.5.</p>\n" + "<details" +
          (rows > kMostRows ? "" : " open") + "><summary>" + Count(rows, "figure") +
          "</summary>\n" + FiguresTable(all) + "</details>\n";
  constexpr std::size_t kMostSequences = 40;
  if (evaluation.sequences.size() > 1) {
    for (std::size_t i = 0; i < std::min(kMostSequences, evaluation.sequences.size()); ++i)
      html += "<details><summary>" + Escaped(evaluation.sequences[i].name) + "</summary>\n" +
              FiguresTable(evaluation.sequences[i]) + "</details>\n";
    if (evaluation.sequences.size() > kMostSequences)
      html += "<p class=\"note\">The others stand in the CSV and JSON reports.</p>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace gestus::cli
