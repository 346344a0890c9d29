// infer-cli eval PREDICTIONS [TRUTH]: the measures of the thesis' evaluations.
#ifndef GESTUS_MODELS_CLI_EVAL_H_
#define GESTUS_MODELS_CLI_EVAL_H_

#include "engine/status.h"
#include "models/cli/args.h"

namespace gestus::cli {

Status RunEval(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_EVAL_H_
