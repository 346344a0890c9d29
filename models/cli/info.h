// infer-cli info WEIGHTS: what a weights file holds, takes and gives.
#ifndef GESTUS_MODELS_CLI_INFO_H_
#define GESTUS_MODELS_CLI_INFO_H_

#include <string>
#include <utility>
#include <vector>

#include "engine/status.h"
#include "models/cli/args.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::cli {

Status RunInfo(const Arguments& arguments);

/// Names and values of the network's configuration, nested ones as "ast_content.frames".
using Fields = std::vector<std::pair<std::string, std::string>>;
Fields ConfigFields(const fb::Network& network);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_INFO_H_
