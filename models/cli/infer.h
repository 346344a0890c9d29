// infer-cli WEIGHTS INPUT.npz: arrays in, arrays out.
#ifndef GESTUS_MODELS_CLI_INFER_H_
#define GESTUS_MODELS_CLI_INFER_H_

#include "engine/status.h"
#include "models/cli/args.h"

namespace gestus::cli {

Status RunInfer(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_INFER_H_
