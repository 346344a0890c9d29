// Styles: what a network takes from a clip of a speaker, computed once and kept in a small file.
//
// A .style file is an .npz with the array `style` and, as `weights_checksum`, the lower and upper
// 32 bits of the checksum of the weights that made it; a style means nothing to other weights.
#ifndef GESTUS_MODELS_CLI_STYLE_H_
#define GESTUS_MODELS_CLI_STYLE_H_

#include <string>

#include "engine/status.h"
#include "models/cli/args.h"
#include "models/cli/setup.h"

namespace gestus::cli {

/// Whether the network takes `name` only to know the style: "style", "style_speech", ...
bool IsStyleInput(const std::string& name);

/// Whether an .npz is a .style file.
Result<bool> IsStyleFile(const std::string& path);
/// Adds to `inputs` the style of a .style file.
Status LoadStyleFile(const Setup& setup, const std::string& path, models::Arrays* inputs);
/// Adds to `inputs` the arrays of a clip, which must be complete; in a clip of its own they need no
/// prefix: "speech" stands for "style_speech".
Status LoadClip(const Setup& setup, const std::string& path, models::Arrays* inputs);
/// The same of what there is: other arrays will be made.
Status LoadPartOfClip(const Setup& setup, const std::string& path, models::Arrays* inputs);

/// The error of a network without a style.
Status NoStyle(const Setup& setup);

/// infer-cli style
Status RunStyle(const Arguments& arguments);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_STYLE_H_
