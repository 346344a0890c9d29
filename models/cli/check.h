// infer-cli check WEIGHTS: runs the self-test that each network carries.
#ifndef GESTUS_MODELS_CLI_CHECK_H_
#define GESTUS_MODELS_CLI_CHECK_H_

#include "engine/status.h"
#include "models/cli/args.h"

namespace gestus::cli {

/// An error when a self-test is missed; networks without one are named and pass.
Status RunCheck(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_CHECK_H_
