// AST alone, on named arrays: spectrograms to embeddings.
#ifndef GESTUS_MODELS_AST_AST_NETWORK_H_
#define GESTUS_MODELS_AST_AST_NETWORK_H_

#include <memory>
#include <string>

#include "models/network.h"

namespace gestus::models {

/// Input `speech` (frames, mel bins); output `embedding` (segments, d_out).
Result<std::unique_ptr<Network>> MakeAstNetwork(std::shared_ptr<const WeightsFile> file,
                                                const std::string& name,
                                                const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_AST_AST_NETWORK_H_
