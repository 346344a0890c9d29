// From command line to network: the steps that every command starts with.
#ifndef GESTUS_MODELS_CLI_SETUP_H_
#define GESTUS_MODELS_CLI_SETUP_H_

#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/cli/args.h"
#include "models/network.h"

namespace gestus::cli {

struct Setup {
  std::shared_ptr<const WeightsFile> weights;
  const kernels::KernelTable* kernels = nullptr;
  std::unique_ptr<models::Network> network;

  bool Trained() const;
};

/// Opens the weights and builds the network that the command line names.  Where it names none and
/// the file holds several, it is the one that takes most of `arrays`, or, when that is empty, of
/// the arrays of the input, which is opened in this case alone.
Result<Setup> OpenNetwork(const Arguments& arguments, std::vector<std::string> arrays = {});

/// What a user of untrained weights must know.
constexpr const char* kUntrained = "UNTRAINED weights: output is noise";

/// Prints `text` to the standard output, completely or with an error.
Status Print(const std::string& text);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_SETUP_H_
