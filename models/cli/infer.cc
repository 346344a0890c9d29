// The run itself: open, read, run, write, report; each step can end it with one sentence.
#include "models/cli/infer.h"

#include "models/cli/machine.h"
#include "models/cli/npz.h"
#include "models/cli/progress.h"
#include "models/cli/report.h"
#include "models/cli/setup.h"
#include "models/cli/style.h"
#include "models/io/text.h"

namespace gestus::cli {
namespace {

using models::Arrays;
using models::ArraySpec;

// A style alone is input enough for `infer-cli style`, but here something must be said with it.
Status CheckAnyInput(const std::vector<ArraySpec>& wanted, const NpzContents& file) {
  const ArraySpec* first = nullptr;
  for (const ArraySpec& spec : wanted) {
    if (IsStyleInput(spec.name)) continue;
    if (file.arrays.count(spec.name) != 0) return Status();
    if (first == nullptr) first = &spec;
  }
  if (first == nullptr) return Status();
  std::string found;
  for (const auto& [name, array] : file.arrays) found += (found.empty() ? "" : ", ") + name;
  for (const std::string& name : file.others) found += (found.empty() ? "" : ", ") + name;
  return Status(Code::kBadInput, first->name + ": missing, found " +
                                     (found.empty() ? "no arrays" : found) + ", expected " +
                                     first->meaning);
}

// Reads INPUT.npz and --style; says in `notes` what it left out.
Result<Arrays> ReadInputs(const Arguments& arguments, const Setup& setup,
                          std::vector<std::string>* notes) {
  std::vector<ArraySpec> wanted;
  for (const ArraySpec& spec : setup.network->signature().inputs) {
    if (arguments.style.empty() || !IsStyleInput(spec.name)) wanted.push_back(spec);
  }
  Result<NpzContents> file = ReadNpz(arguments.input, wanted);
  if (!file.ok()) return file.status();
  GESTUS_RETURN_IF_ERROR(CheckAnyInput(wanted, *file).In(arguments.input));
  for (const std::string& name : file->others) {
    notes->push_back(name + " in " + arguments.input + " was not used");
  }
  if (!arguments.style.empty()) {
    GESTUS_RETURN_IF_ERROR(LoadStyle(setup, arguments.style, &file->arrays));
  }
  return std::move(file->arrays);
}

Result<Arrays> RunNetwork(const Arguments& arguments, const Arrays& inputs, Setup* setup,
                          models::RunReport* report) {
  Progress progress(report);
  models::RunOptions options;
  options.threads = arguments.threads;
  options.repeat = arguments.repeat;
  options.sampling = arguments.sampling;
  options.profile = arguments.profile;
  options.taps = arguments.taps;
  options.progress = [&progress](std::size_t done, std::size_t total) {
    progress.Show(done, total);
  };
  Result<Arrays> outputs = setup->network->Run(inputs, options, report);
  if (outputs.ok()) return outputs;
  const std::string message = outputs.status().message();
  const bool from_style =
      !arguments.style.empty() && IsStyleInput(message.substr(0, message.find(':')));
  return outputs.status().In(from_style ? arguments.style : arguments.input);
}

}  // namespace

Status RunInfer(const Arguments& arguments) {
  Result<Setup> setup = OpenNetwork(arguments);
  if (!setup.ok()) return setup.status();
  models::RunReport report;
  if (const std::string note = IgnoredIsaNote(); arguments.isa.empty() && !note.empty()) {
    report.notes.push_back(note);
  }
  const Result<Arrays> inputs = ReadInputs(arguments, *setup, &report.notes);
  if (!inputs.ok()) return inputs.status();
  // Created before the work, so that a forbidden path is told at once.
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);

  const Result<Arrays> outputs = RunNetwork(arguments, *inputs, &*setup, &report);
  if (!outputs.ok()) return outputs.status();
  GESTUS_RETURN_IF_ERROR(WriteNpz(*outputs, &*file).In(arguments.output));
  GESTUS_RETURN_IF_ERROR(file->Commit().In(arguments.output));

  const InferReport said{arguments, *setup, *inputs, *outputs, report};
  return Print(arguments.json ? said.Json() : said.Text());
}

}  // namespace gestus::cli
