// Timing statistics and the two forms of the report.
#include "models/cli/report.h"

#include <algorithm>

#include "models/cli/json.h"
#include "models/cli/npy.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using models::Array;

const char* NumpyName(DType dtype) { return dtype == DType::kF32 ? "float32" : "int32"; }

// "speech (192, 128)"
std::string ArrayText(const std::string& name, const Array& array) {
  return name + " " + ShapeText(array.shape);
}

}  // namespace

std::string ArraysText(const models::Arrays& arrays) {
  std::string text;
  std::size_t taps = 0;
  for (const auto& [name, array] : arrays) {
    if (name.starts_with("tap/")) {
      ++taps;
    } else {
      text += (text.empty() ? "" : ", ") + ArrayText(name, array);
    }
  }
  if (taps > 0) text += " and " + Count(taps, "tap");
  return text;
}

namespace {

// "body 12.3 -> 4.56 shoulder lengths/s^3"
std::string JerkText(const outputs::Finished& finished) {
  std::string text;
  for (const outputs::Jerk& before : finished.before) {
    text += (text.empty() ? "" : ", ") + before.part + " " + Significant(before.value, 3);
    for (const outputs::Jerk& after : finished.after) {
      if (after.part == before.part) text += " -> " + Significant(after.value, 3);
    }
    text += " " + before.unit;
  }
  return text;
}

void JerkJson(JsonWriter* json, const char* key, const std::vector<outputs::Jerk>& jerks) {
  json->Key(key).BeginArray();
  for (const outputs::Jerk& jerk : jerks) {
    json->BeginObject().Member("part", jerk.part).Member("unit", jerk.unit);
    json->Member("value", jerk.value).EndObject();
  }
  json->EndArray();
}

void FinishJson(JsonWriter* json, const outputs::FinishOptions& options,
                const outputs::Finished& finished) {
  const bool linear = options.interpolation == outputs::Interpolation::kLinear;
  json->Key("finish")
      .BeginObject()
      .Member("frames", finished.motion.frames)
      .Member("frame_rate", finished.motion.frame_rate)
      .Member("interpolation", linear ? "linear" : "monotone")
      .Member("crossfade", options.crossfade)
      .Member("smooth", options.smooth)
      .Member("amplitude", options.amplitude);
  JerkJson(json, "jerk_before", finished.before);
  JerkJson(json, "jerk_after", finished.after);
  json->EndObject();
}

void ArraysJson(JsonWriter* json, const char* key, const models::Arrays& arrays) {
  json->Key(key).BeginArray();
  for (const auto& [name, array] : arrays) {
    json->BeginObject().Member("name", name).Member("dtype", NumpyName(array.dtype));
    json->Member("shape", array.shape).EndObject();
  }
  json->EndArray();
}

void ProfileJson(JsonWriter* json, const std::vector<OpProfile>& ops) {
  json->Key("profile").BeginArray();
  for (const OpProfile& op : ops) {
    json->BeginObject()
        .Member("name", op.name)
        .Member("runs", op.runs)
        .Member("seconds", op.seconds)
        .Member("flops", op.flops)
        .Member("bytes", op.bytes)
        .EndObject();
  }
  json->EndArray();
}

// The kind of an op is the last word of its name, "linear" in "content/ast/block.0 linear".
std::vector<OpProfile> ByKind(const std::vector<OpProfile>& ops) {
  std::vector<OpProfile> kinds;
  for (const OpProfile& op : ops) {
    const std::string kind = op.name.substr(op.name.rfind(' ') + 1);
    auto found = std::find_if(kinds.begin(), kinds.end(),
                              [&](const OpProfile& k) { return k.name == kind; });
    if (found == kinds.end()) {
      found = kinds.insert(found, OpProfile{});
      found->name = kind;
    }
    found->runs += op.runs;
    found->seconds += op.seconds;
    found->flops += op.flops;
    found->bytes += op.bytes;
  }
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const OpProfile& a, const OpProfile& b) { return a.seconds > b.seconds; });
  return kinds;
}

std::string ProfileTable(const std::vector<OpProfile>& ops, double total) {
  std::vector<std::vector<std::string>> rows = {{"op", "runs", "time", "share", "GFLOP/s", "GB/s"}};
  for (const OpProfile& op : ops) {
    const auto rate = [&](double amount) {
      return op.seconds > 0 ? Significant(amount / op.seconds * 1e-9, 3) : "-";
    };
    rows.push_back({op.name, Grouped(op.runs), Seconds(op.seconds),
                    Fixed(total > 0 ? 100 * op.seconds / total : 0, 1) + " %", rate(op.flops),
                    rate(op.bytes)});
  }
  return Table(rows, {1, 2, 3, 4, 5});
}

}  // namespace

Timing Summarise(const models::RunReport& report, int repeat) {
  Timing timing;
  std::vector<double> seconds = report.segment_seconds;
  if (seconds.empty()) return timing;
  std::sort(seconds.begin(), seconds.end());
  timing.segments = seconds.size() / static_cast<std::size_t>(std::max(repeat, 1));
  timing.median = seconds[seconds.size() / 2];
  timing.p99 = seconds[std::min(seconds.size() - 1, seconds.size() * 99 / 100)];
  const double once = timing.median * static_cast<double>(timing.segments);
  if (once > 0 && report.frame_rate > 0) {
    timing.times_real_time = static_cast<double>(report.frames) / report.frame_rate / once;
  }
  return timing;
}

std::string ProfileText(const std::vector<OpProfile>& ops) {
  double total = 0;
  for (const OpProfile& op : ops) total += op.seconds;
  return "profile by kind of op\n" + ProfileTable(ByKind(ops), total) +
         "profile in order of execution\n" + ProfileTable(ops, total);
}

std::string InferReport::Text() const {
  const Timing timing = Summarise(run, arguments.repeat);
  std::string text;
  for (const std::string& line : style_used) text += "style  " + line + "\n";
  for (const std::string& line : used) text += "read   " + line + "\n";
  text += "wrote  " + arguments.output + ": " + ArraysText(outputs);
  if (run.frame_rate > 0) {
    text += ", " + Significant(static_cast<double>(run.frames) / run.frame_rate, 3) + " s at " +
            Significant(run.frame_rate, 3) + " frames/s";
  }
  for (const std::string& line : exports) text += "\nwrote  " + line;
  for (const std::string& line : views) text += "\nwrote  " + line;
  if (finished.has_value() && !finished->before.empty()) text += "\njerk   " + JerkText(*finished);
  text += "\nspeed  " + Seconds(timing.median) + " a segment";
  if (arguments.repeat > 1) text += " (median; p99 " + Seconds(timing.p99) + ")";
  text += ", " + Count(timing.segments, "segment");
  if (timing.times_real_time > 0) {
    text += ", " + Significant(timing.times_real_time, 3) + " times real time";
  }
  text += ", " + Count(static_cast<std::uint64_t>(arguments.threads), "thread") + ", " +
          setup.kernels->name + "\n";
  for (const std::string& note : run.notes) text += "note   " + note + "\n";
  if (!setup.Trained()) text += std::string("note   ") + kUntrained + "\n";
  if (arguments.plan) text += "\n" + setup.network->PlanText();
  if (arguments.profile) text += "\n" + ProfileText(run.ops);
  return text;
}

std::string InferReport::Json() const {
  const Timing timing = Summarise(run, arguments.repeat);
  JsonWriter json;
  json.BeginObject()
      .Member("weights", arguments.weights)
      .Member("kind", setup.network->kind())
      .Member("trained", setup.Trained())
      .Member("input", arguments.Input())
      .Member("output", arguments.output);
  json.Member("exports", exports)
      .Member("views", views)
      .Member("used", used)
      .Member("style_used", style_used);
  ArraysJson(&json, "inputs", inputs);
  ArraysJson(&json, "outputs", outputs);
  json.Member("segments", static_cast<std::uint64_t>(timing.segments))
      .Member("frames", static_cast<std::uint64_t>(run.frames))
      .Member("frame_rate", run.frame_rate)
      .Member("repeat", arguments.repeat)
      .Member("segment_seconds_median", timing.median)
      .Member("segment_seconds_p99", timing.p99)
      .Member("times_real_time", timing.times_real_time)
      .Member("threads", arguments.threads)
      .Member("isa", setup.kernels->name)
      .Member("notes", run.notes);
  if (finished.has_value()) FinishJson(&json, *arguments.finish, *finished);
  if (arguments.plan) json.Member("plan", setup.network->PlanText());
  if (arguments.profile) ProfileJson(&json, run.ops);
  json.EndObject();
  return json.text();
}

}  // namespace gestus::cli
