// Read, pair, evaluate, report; each step can end it with one sentence.
#include "models/cli/eval.h"

#include <algorithm>
#include <array>
#include <optional>

#include "models/cli/eval_report.h"
#include "models/cli/eval_scores.h"
#include "models/cli/eval_transfer.h"
#include "models/cli/setup.h"
#include "models/io/file.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

Status CheckOptions(const Arguments& arguments) {
  const EvalOptions& eval = arguments.eval;
  if (eval.median % 2 == 0)
    return Status(Code::kInvalidArgument, "command line: --median " + std::to_string(eval.median) +
                                              ", expected an odd number");
  if (!eval.classifier.empty() && arguments.weights.empty())
    return Status(Code::kInvalidArgument,
                  "command line: --classifier without --weights, expected the file that holds it");
  if (arguments.output.empty() || FormatOf(arguments.output)) return Status();
  return Status(Code::kInvalidArgument,
                arguments.output + ": unknown ending, expected .html, .csv, .json or .txt");
}

/// Predictions first: the others follow their frame rate.
Status ReadAll(const std::array<std::string, kRoles>& paths, SequenceReader* reader,
               std::array<bool, kRoles>* folders, Material* material) {
  double rate = 0;
  for (const Role role : {kPrediction, kTruth, kSource, kTarget}) {
    if (paths[role].empty()) continue;
    const Result<SequenceSet> set = FindSequences(paths[role], &material->notes);
    if (!set.ok()) return set.status();
    (*folders)[role] = set->folder;
    for (const SequenceFile& file : set->files) {
      Result<Sequence> sequence = reader->Read(file, rate);
      if (!sequence.ok()) return sequence.status();
      if (rate <= 0) rate = sequence->motion.frame_rate;
      material->sequences[role].push_back(*std::move(sequence));
    }
  }
  return Status();
}

}  // namespace

Status RunEval(const Arguments& arguments) {
  GESTUS_RETURN_IF_ERROR(CheckOptions(arguments));
  const EvalOptions& eval = arguments.eval;
  // Created before the work, so that a forbidden path is told at once.
  std::optional<Result<AtomicFile>> file;
  if (!arguments.output.empty()) {
    file.emplace(AtomicFile::Create(arguments.output));
    if (!file->ok()) return file->status().In(arguments.output);
  }
  Result<SequenceReader> reader = SequenceReader::Make(arguments);
  if (!reader.ok()) return reader.status();
  Material material;
  std::array<bool, kRoles> folders{};
  GESTUS_RETURN_IF_ERROR(ReadAll({eval.predictions, eval.truth, eval.source, eval.target}, &*reader,
                                 &folders, &material));
  for (const std::string& note : reader->notes()) {
    // A file may play two roles.
    if (std::find(material.notes.begin(), material.notes.end(), note) == material.notes.end())
      material.notes.push_back(note);
  }
  GESTUS_RETURN_IF_ERROR(PairSequences(folders, &material));
  Result<Evaluation> evaluation = Evaluate({.median = eval.median, .order = eval.order}, &material);
  if (!evaluation.ok()) return evaluation.status();
  const Result<std::string> classifier =
      AddTransfer(arguments, reader->weights(), &material, &*evaluation);
  if (!classifier.ok()) return classifier.status();

  const EvalReport report{
      arguments, material, *evaluation, *classifier,
      reader->weights() == nullptr || reader->weights()->root().provenance()->trained()};
  if (file) {
    const std::string text = report.In(*FormatOf(arguments.output));
    GESTUS_RETURN_IF_ERROR((*file)->Write(text.data(), text.size()).In(arguments.output));
    GESTUS_RETURN_IF_ERROR((*file)->Commit().In(arguments.output));
  }
  return Print(arguments.json ? report.Json() : report.Text());
}

}  // namespace gestus::cli
