// infer-cli style info, blend, distance and gallery: what can be done with styles that are there.
#ifndef GESTUS_MODELS_CLI_STYLE_COMMANDS_H_
#define GESTUS_MODELS_CLI_STYLE_COMMANDS_H_

#include "engine/status.h"
#include "models/cli/args.h"

namespace gestus::cli {

Status RunStyleInfo(const Arguments& arguments);
Status RunStyleBlend(const Arguments& arguments);
Status RunStyleDistance(const Arguments& arguments);
Status RunStyleGallery(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_STYLE_COMMANDS_H_
