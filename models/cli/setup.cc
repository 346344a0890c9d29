// Opening weights and making networks, in the order in which errors are most useful.
#include "models/cli/setup.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "models/cli/machine.h"
#include "weights_generated.h"

namespace gestus::cli {

bool Setup::Trained() const { return weights->root().provenance()->trained(); }

Result<Setup> OpenNetwork(const Arguments& arguments) {
  const Result<const kernels::KernelTable*> kernels = ChooseKernels(arguments.isa);
  if (!kernels.ok()) return kernels.status();
  Setup setup;
  setup.kernels = *kernels;
  Result<std::shared_ptr<const WeightsFile>> weights = WeightsFile::Open(arguments.weights);
  if (!weights.ok()) return weights.status();
  setup.weights = *std::move(weights);
  models::NetworkOptions options;
  options.kernels = setup.kernels;
  Result<std::unique_ptr<models::Network>> network =
      models::MakeNetwork(setup.weights, arguments.network, options);
  if (!network.ok()) return network.status();
  setup.network = *std::move(network);
  return setup;
}

Status Print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) {
    return Status();
  }
  return Status(Code::kIo, std::string("standard output: cannot be written (") +
                               std::strerror(errno) + "), expected an open file, pipe or terminal");
}

}  // namespace gestus::cli
