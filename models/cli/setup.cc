// Opening weights and making networks, in the order in which errors are most useful.
#include "models/cli/setup.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "models/cli/machine.h"
#include "weights_generated.h"

namespace gestus::cli {

bool Setup::Trained() const { return weights->root().provenance()->trained(); }

namespace {

/// How well `arrays` fit: by how many of them the network takes, then by whether it needs any of
/// them; -1 when one is missing that it needs.
int Fit(const models::Signature& signature, const std::vector<std::string>& arrays) {
  int taken = 0;
  bool needs = false;
  for (const models::ArraySpec& spec : signature.inputs) {
    const bool given = std::find(arrays.begin(), arrays.end(), spec.name) != arrays.end();
    if (spec.required && !given) return -1;
    taken += given;
    needs = needs || spec.required;
  }
  return 2 * taken + (taken > 0 && needs ? 1 : 0);
}

Result<std::string> ChooseNetwork(const std::shared_ptr<const WeightsFile>& weights,
                                  const Offers& offers) {
  std::string best, names;
  int most = 0;
  for (const fb::Network* stored : *weights->root().networks()) {
    const std::string name = stored->name()->str();
    names += (names.empty() ? "" : ", ") + name;
    auto network = models::MakeNetwork(weights, name, {.plan = false});
    if (!network.ok()) return network.status();
    const Result<std::vector<std::string>> offered = offers(*stored);
    if (!offered.ok()) return offered.status();
    const int fit = Fit((*network)->signature(), *offered);
    if (fit == most) best.clear();  // none is the one
    if (fit > most) {
      most = fit;
      best = name;
    }
  }
  if (!best.empty()) return best;
  return Status(Code::kInvalidArgument, weights->path() + ": the input does not tell which of " +
                                            names + " is meant, expected --network NAME");
}

}  // namespace

Result<Setup> OpenNetwork(const Arguments& arguments, const Offers& offers) {
  const Result<const kernels::KernelTable*> kernels = ChooseKernels(arguments.isa);
  if (!kernels.ok()) return kernels.status();
  Setup setup;
  setup.kernels = *kernels;
  Result<std::shared_ptr<const WeightsFile>> weights =
      WeightsFile::Open(arguments.weights, {.residence = Residence::kCopied});
  if (!weights.ok()) return weights.status();
  setup.weights = *std::move(weights);
  std::string name = arguments.network;
  if (name.empty() && setup.weights->root().networks()->size() > 1) {
    Result<std::string> chosen = ChooseNetwork(setup.weights, offers);
    if (!chosen.ok()) return chosen.status();
    name = *std::move(chosen);
  }
  models::NetworkOptions options;
  options.kernels = setup.kernels;
  Result<std::unique_ptr<models::Network>> network =
      models::MakeNetwork(setup.weights, name, options);
  if (!network.ok()) return network.status();
  setup.network = *std::move(network);
  setup.name = setup.weights->FindNetwork(name)->name()->str();
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
