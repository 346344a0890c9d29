// ZS-MSTM 1.0 on named arrays of any length.
#ifndef GESTUS_MODELS_ZS_MSTM1_ZS_MSTM1_NETWORK_H_
#define GESTUS_MODELS_ZS_MSTM1_ZS_MSTM1_NETWORK_H_

#include <memory>
#include <string>

#include "models/network.h"

namespace gestus::models {

/// Inputs `speech`, `text` and either `style` or `style_speech`, `style_text`, `style_pose`;
/// outputs `pose` (absent when only a style clip is given) and `style`.
Result<std::unique_ptr<Network>> MakeZsMstm1Network(std::shared_ptr<const WeightsFile> file,
                                                    const std::string& name,
                                                    const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM1_ZS_MSTM1_NETWORK_H_
