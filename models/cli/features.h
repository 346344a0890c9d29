// infer-cli features: what recordings and words are made into, stage by stage.
#ifndef GESTUS_MODELS_CLI_FEATURES_H_
#define GESTUS_MODELS_CLI_FEATURES_H_

#include "engine/status.h"
#include "models/cli/args.h"

namespace gestus::cli {

Status RunFeatures(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_FEATURES_H_
