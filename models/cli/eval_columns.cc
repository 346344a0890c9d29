#include "models/cli/eval_columns.h"

#include <algorithm>
#include <optional>

#include "models/io/text.h"
#include "models/metrics/points.h"

namespace gestus::cli {
namespace {

const EvalChannel* Find(const Sequence& sequence, const std::string& name) {
  const auto found = std::find_if(sequence.channels.begin(), sequence.channels.end(),
                                  [&](const EvalChannel& c) { return c.name == name; });
  return found == sequence.channels.end() ? nullptr : &*found;
}

std::string GroupOf(const std::string& name) {
  if (name.starts_with("AU")) return kActionUnits;
  return name == "Rx" || name == "Ry" || name == "Rz" ? kHead : kOtherCurves;
}

std::uint64_t CountValues(const EvalChannel& channel) {
  std::uint64_t values = 0;
  for (const Stretch& stretch : channel.stretches) values += stretch.values.size();
  return values;
}

void JoinOneByOne(const EvalChannel& p, const EvalChannel& t, Column* column) {
  for (std::size_t i = 0; i < p.stretches.size(); ++i) {
    const auto &a = p.stretches[i].values, &b = t.stretches[i].values;
    const auto n = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
    column->predicted.insert(column->predicted.end(), a.begin(), a.begin() + n);
    column->truth.insert(column->truth.end(), b.begin(), b.begin() + n);
  }
}

/// The channel's value in every frame that it has one for; a stretch ends where the next begins.
std::vector<std::optional<float>> OnTime(const EvalChannel& channel, std::int64_t end) {
  std::vector<std::optional<float>> frames(static_cast<std::size_t>(end));
  for (std::size_t n = 0; n < channel.stretches.size(); ++n) {
    const auto& [begin, values] = channel.stretches[n];
    std::int64_t stop = std::min(end, begin + static_cast<std::int64_t>(values.size()));
    if (n + 1 < channel.stretches.size()) stop = std::min(stop, channel.stretches[n + 1].begin);
    for (std::int64_t i = std::max<std::int64_t>(begin, 0); i < stop; ++i)
      frames[static_cast<std::size_t>(i)] = values[static_cast<std::size_t>(i - begin)];
  }
  return frames;
}

std::int64_t EndOf(const EvalChannel& channel) {
  std::int64_t end = 0;
  for (const Stretch& stretch : channel.stretches)
    end = std::max(end, stretch.begin + static_cast<std::int64_t>(stretch.values.size()));
  return end;
}

void JoinByTime(const EvalChannel& p, const EvalChannel& t, Column* column) {
  const std::int64_t end = std::min(EndOf(p), EndOf(t));
  const auto predicted = OnTime(p, end), truth = OnTime(t, end);
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    if (!predicted[i] || !truth[i]) continue;
    column->predicted.push_back(*predicted[i]);
    column->truth.push_back(*truth[i]);
  }
}

void NoteCut(const Sequence& prediction, std::uint64_t predicted, std::uint64_t true_ones,
             std::uint64_t compared, std::vector<std::string>* notes) {
  if (compared == predicted && compared == true_ones) return;
  notes->push_back(prediction.path + ": lengths differ; " + std::to_string(compared) + " of " +
                   std::to_string(predicted) + " predicted and " + std::to_string(true_ones) +
                   " true values were compared");
}

void AddPoints(const std::optional<outputs::Figure>& predicted,
               const std::optional<outputs::Figure>& truth, const std::string& group,
               std::span<const std::int64_t> sources, std::int64_t frames,
               std::vector<Column>* columns) {
  if (!predicted || !truth) return;
  const auto p = metrics::PointsWith(*predicted, sources), t = metrics::PointsWith(*truth, sources);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string& name = predicted->points[p[i]].name;
    Column x{group, name + " x", "units", {}, {}}, y{group, name + " y", "units", {}, {}};
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      x.predicted.push_back(predicted->x(frame, p[i]));
      y.predicted.push_back(predicted->y(frame, p[i]));
      x.truth.push_back(truth->x(frame, t[i]));
      y.truth.push_back(truth->y(frame, t[i]));
    }
    columns->push_back(std::move(x));
    columns->push_back(std::move(y));
  }
}

}  // namespace

bool IsCurve(const Column& column) {
  return column.group == kActionUnits || column.group == kHead || column.group == kOtherCurves;
}

Result<std::vector<Column>> CurveColumns(const Sequence& prediction, const Sequence& truth,
                                         const std::vector<std::string>& names,
                                         std::vector<std::string>* notes) {
  std::vector<Column> columns;
  std::uint64_t predicted = 0, true_ones = 0, compared = 0;
  for (const std::string& name : names) {
    const EvalChannel *p = Find(prediction, name), *t = Find(truth, name);
    if (p == nullptr || t == nullptr) continue;
    Column column{GroupOf(name), name, p->unit, {}, {}};
    if (prediction.recorded == truth.recorded && p->stretches.size() == t->stretches.size()) {
      JoinOneByOne(*p, *t, &column);
    } else if (prediction.timed && truth.timed) {
      JoinByTime(*p, *t, &column);
    } else {
      const Sequence& untimed = prediction.timed ? truth : prediction;
      const Sequence& other = prediction.timed ? prediction : truth;
      return Status(Code::kBadInput, untimed.path +
                                         ": has no times_ms and not as many sequences as " +
                                         other.path + ", expected the array times_ms");
    }
    predicted += CountValues(*p);
    true_ones += CountValues(*t);
    compared += column.truth.size();
    columns.push_back(std::move(column));
  }
  NoteCut(prediction, predicted, true_ones, compared, notes);
  return columns;
}

std::vector<Column> PointColumns(const Sequence& prediction, const Sequence& truth,
                                 std::span<const std::int64_t> joints,
                                 std::span<const std::int64_t> landmarks) {
  std::vector<Column> columns;
  const std::int64_t frames = std::min(prediction.motion.frames, truth.motion.frames);
  AddPoints(prediction.motion.body, truth.motion.body, "body", joints, frames, &columns);
  AddPoints(prediction.motion.face, truth.motion.face, "face", landmarks, frames, &columns);
  return columns;
}

}  // namespace gestus::cli
