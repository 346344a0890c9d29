// ZS-MSTM 1.0 and 2.0 on named arrays of any length.
#ifndef GESTUS_MODELS_ZS_MSTM_ZS_MSTM_NETWORK_H_
#define GESTUS_MODELS_ZS_MSTM_ZS_MSTM_NETWORK_H_

#include <memory>
#include <string>

#include "models/network.h"

namespace gestus::models {

/// Inputs `speech`, `text` and either `style` or `style_speech`, `style_text`, `style_pose` (and,
/// in 2.0, `style_face` and `style_tags`); outputs `pose` (and `face`), absent when only a style
/// clip is given, and `style`.
Result<std::unique_ptr<Network>> MakeZsMstmNetwork(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM_ZS_MSTM_NETWORK_H_
