// The run itself: open, read, run, write, report; each step can end it with one sentence.
#include "models/cli/infer.h"

#include <algorithm>

#include "models/cli/export.h"
#include "models/cli/feed.h"
#include "models/cli/finish.h"
#include "models/cli/inputs.h"
#include "models/cli/machine.h"
#include "models/cli/npz.h"
#include "models/cli/progress.h"
#include "models/cli/report.h"
#include "models/cli/setup.h"
#include "models/cli/style.h"
#include "models/cli/views.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::Arrays;

// About so many items run at once: minutes of motion, some megabytes of features.
constexpr std::int64_t kStretch = 4096;

/// Adds what the report of one stretch says.
void Merge(models::RunReport&& from, models::RunReport* into) {
  into->segment_seconds.insert(into->segment_seconds.end(), from.segment_seconds.begin(),
                               from.segment_seconds.end());
  into->frames += from.frames;
  into->frame_rate = from.frame_rate;
  for (std::string& note : from.notes) {
    if (std::find(into->notes.begin(), into->notes.end(), note) == into->notes.end())
      into->notes.push_back(std::move(note));
  }
  if (into->ops.empty()) {
    into->ops = std::move(from.ops);
    return;
  }
  for (std::size_t i = 0; i < std::min(into->ops.size(), from.ops.size()); ++i) {
    into->ops[i].runs += from.ops[i].runs;
    into->ops[i].seconds += from.ops[i].seconds;
    into->ops[i].flops += from.ops[i].flops;
    into->ops[i].bytes += from.ops[i].bytes;
  }
}

/// Rows of one stretch behind those of the others; a style and taps have no rows of time.
void Append(Arrays&& from, Arrays* into) {
  for (auto& [name, array] : from) {
    const auto found = into->find(name);
    if (found == into->end() || name == "style" || name.starts_with("tap/")) {
      (*into)[name] = std::move(array);
      continue;
    }
    Array& whole = found->second;
    whole.shape[0] += array.shape[0];
    whole.f32.insert(whole.f32.end(), array.f32.begin(), array.f32.end());
    whole.i32.insert(whole.i32.end(), array.i32.begin(), array.i32.end());
  }
}

/// Says which file an array of the network's complaint came from.
Status Blame(const Arguments& arguments, const Status& status) {
  const std::string& message = status.message();
  const bool from_style =
      !arguments.style.empty() && IsStyleInput(message.substr(0, message.find(':')));
  return status.In(from_style ? arguments.style : arguments.Input());
}

/// A clip becomes a style once, before the speech runs in stretches.
Status TakeStyle(const Arguments& arguments, Setup* setup, models::RunReport* report,
                 Arrays* style) {
  if (style->empty() || style->count("style") != 0) return Status();
  models::RunOptions options;
  options.threads = arguments.threads;
  models::RunReport own;
  Result<Arrays> made = setup->network->Run(*style, options, &own);
  if (!made.ok()) return Blame(arguments, made.status());
  report->notes.insert(report->notes.end(), own.notes.begin(), own.notes.end());
  *style = {{"style", std::move(made->at("style"))}};
  return Status();
}

models::RunOptions OptionsOf(const Arguments& arguments) {
  models::RunOptions options;
  options.threads = arguments.threads;
  options.repeat = arguments.repeat;
  options.sampling = arguments.sampling;
  options.profile = arguments.profile;
  options.taps = arguments.taps;
  return options;
}

/// Runs the network over all that the stream gives.
Result<Arrays> RunAll(const Arguments& arguments, Setup* setup, Feed* feed,
                      models::RunReport* report) {
  if (!feed->only_arrays) GESTUS_RETURN_IF_ERROR(TakeStyle(arguments, setup, report, &feed->style));
  models::RunOptions options = OptionsOf(arguments);
  models::RunReport stretch, shown;  // shown: what the progress bar goes by
  Progress progress(&shown);
  const std::int64_t total = feed->stream->total(), unit = feed->stream->unit();
  Arrays outputs;
  for (std::int64_t done = 0; done < total;) {
    const std::int64_t count = features::Stretch(total - done, unit, kStretch);
    Result<Arrays> inputs = feed->stream->Next(count);
    if (!inputs.ok()) return inputs.status();
    inputs->insert(feed->style.begin(), feed->style.end());
    stretch = {};
    const auto before = static_cast<std::size_t>(done / unit);
    options.progress = [&](std::size_t run, std::size_t runs) {
      shown.frame_rate = stretch.frame_rate;
      shown.frames = count == total ? stretch.frames : static_cast<std::size_t>(total);
      progress.Show(before + run,
                    count == total ? runs : static_cast<std::size_t>((total + unit - 1) / unit));
    };
    Result<Arrays> made = setup->network->Run(*inputs, options, &stretch);
    if (!made.ok()) return Blame(arguments, made.status());
    // Words come from the front end in windows that it has told of.
    if (!feed->only_arrays && feed->front_end->spec().layout == features::Layout::kWindows)
      stretch.notes.clear();
    Merge(std::move(stretch), report);
    Append(*std::move(made), &outputs);
    done += count;
  }
  outputs.merge(feed->stream->Beside());
  for (std::string& note : feed->stream->Notes()) feed->account.notes.push_back(std::move(note));
  return outputs;
}

}  // namespace

Status RunInfer(const Arguments& arguments) {
  const Result<Exports> exports = ParseExports(arguments);
  if (!exports.ok()) return exports.status();
  const Result<Inputs> given = SortInputs(arguments.inputs, arguments.words);
  if (!given.ok()) return given.status();
  Result<Setup> setup = OpenNetworkFor(arguments, *given);
  if (!setup.ok()) return setup.status();
  models::RunReport report;
  if (const std::string note = IgnoredIsaNote(); arguments.isa.empty() && !note.empty()) {
    report.notes.push_back(note);
  }
  GESTUS_RETURN_IF_ERROR(CheckExports(*setup->weights->FindNetwork(setup->name), *exports));
  Result<Feed> feed = OpenFeed(arguments, *given, *setup);
  if (!feed.ok()) return feed.status();
  // Created before the work, so that a forbidden path is told at once.
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);
  Result<Views> views = Views::Open(arguments, *setup);
  if (!views.ok()) return views.status();

  Result<Arrays> outputs = RunAll(arguments, &*setup, &*feed, &report);
  if (!outputs.ok()) return outputs.status();
  const auto finished = FinishOutputs(arguments, *setup, &*outputs, &report);
  if (!finished.ok()) return finished.status();
  GESTUS_RETURN_IF_ERROR(WriteNpz(*outputs, &*file).In(arguments.output));
  std::vector<std::string> written;
  if (views->Any() || !exports->files.empty()) {
    const Result<outputs::Motion> motion =
        finished->has_value()
            ? Result<outputs::Motion>((*finished)->motion)
            : outputs::MotionOf(*setup->weights->FindNetwork(setup->name), *outputs);
    if (!motion.ok()) return motion.status().In(arguments.weights);
    GESTUS_RETURN_IF_ERROR(
        views->Write(arguments, *given, *setup, *motion, &written, &report.notes));
    GESTUS_RETURN_IF_ERROR(WriteExports(*motion, *exports));
  }
  GESTUS_RETURN_IF_ERROR(file->Commit().In(arguments.output));

  report.notes.insert(report.notes.begin(), feed->account.notes.begin(), feed->account.notes.end());
  const std::vector<std::string> exported = exports->Lines();
  const InferReport said{arguments,    *setup,   feed->account.used, feed->style_used,
                         feed->arrays, *outputs, exported,           written,
                         report,       *finished};
  return Print(arguments.json ? said.Json() : said.Text());
}

}  // namespace gestus::cli
