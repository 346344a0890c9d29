// Styles: what a network takes from a clip of a speaker, computed once and kept in a small file; a
// style means nothing to other weights than those that made it.
#ifndef GESTUS_MODELS_CLI_STYLE_H_
#define GESTUS_MODELS_CLI_STYLE_H_

#include <string>

#include "engine/status.h"
#include "models/cli/args.h"
#include "models/cli/setup.h"

namespace gestus::cli {

/// Whether the network takes `name` only to know the style: "style", "style_speech", ...
bool IsStyleInput(const std::string& name);

/// Adds to `inputs` the style of a .style file.
Status LoadStyleFile(const Setup& setup, const std::string& path, models::Arrays* inputs);
/// Adds to `inputs` the arrays of a clip, which must be complete; in a clip of its own they need no
/// prefix: "speech" stands for "style_speech".
Status LoadClip(const Setup& setup, const std::string& path, models::Arrays* inputs);
/// The same of what there is: other arrays will be made.
Status LoadPartOfClip(const Setup& setup, const std::string& path, models::Arrays* inputs);

/// The error of a network without a style.
Status NoStyle(const Setup& setup);

/// infer-cli style extract
Status RunStyle(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_STYLE_H_
