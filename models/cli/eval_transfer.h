// Transfer strength: runs classifier C of the weights file over the motion.
#ifndef GESTUS_MODELS_CLI_EVAL_TRANSFER_H_
#define GESTUS_MODELS_CLI_EVAL_TRANSFER_H_

#include <memory>
#include <string>

#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/cli/args.h"
#include "models/cli/eval_scores.h"

namespace gestus::cli {

/// Adds Scores::transfer of every case, and of all of them together, with those of the sources and
/// targets.  Returns the classifier's name; empty where the file has none, or (noted) one that
/// takes other motion.  Errors: --classifier names none, or one that takes other motion; several.
Result<std::string> AddTransfer(const Arguments& arguments,
                                const std::shared_ptr<const WeightsFile>& weights,
                                Material* material, Evaluation* evaluation);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_TRANSFER_H_
