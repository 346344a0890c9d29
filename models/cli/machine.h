// Which kernels this machine runs, and what this build is.
#ifndef GESTUS_MODELS_CLI_MACHINE_H_
#define GESTUS_MODELS_CLI_MACHINE_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "kernels/kernels.h"

namespace gestus::cli {

/// Names of the instruction sets that this binary has kernels for and this machine runs.
std::vector<std::string> AvailableIsas();

/// The kernels for `isa`, or the best ones when it is empty.
Result<const kernels::KernelTable*> ChooseKernels(const std::string& isa);

/// "GESTUS_ISA=avx1024 is ignored ..." when the environment asks for what there is not; empty
/// otherwise.
std::string IgnoredIsaNote();

std::string VersionText();
std::string VersionJson();

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_MACHINE_H_
