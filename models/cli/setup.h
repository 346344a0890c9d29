// From command line to network: the steps that every command starts with.
#ifndef GESTUS_MODELS_CLI_SETUP_H_
#define GESTUS_MODELS_CLI_SETUP_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/cli/args.h"
#include "models/network.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::cli {

struct Setup {
  std::shared_ptr<const WeightsFile> weights;
  const kernels::KernelTable* kernels = nullptr;
  std::string name;  ///< of the network
  std::unique_ptr<models::Network> network;

  bool Trained() const;
};

/// Names of the arrays that there would be for a network.
using Offers = std::function<Result<std::vector<std::string>>(const fb::Network&)>;

/// Opens the weights and builds the network that the command line names.  Where it names none and
/// the file holds several, it is the one that takes most of what is offered.
Result<Setup> OpenNetwork(const Arguments& arguments, const Offers& offers);

/// What a user of untrained weights must know.
constexpr const char* kUntrained = "UNTRAINED weights: output is noise";

/// Prints `text` to the standard output, completely or with an error.
Status Print(const std::string& text);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_SETUP_H_
