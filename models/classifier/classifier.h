// Classifier C (thesis 7.5.1, figure 7.3): does a piece of motion carry the source style, at most
// 0.5, or the target style, above it?  Transfer strength counts its answers.
#ifndef GESTUS_MODELS_CLASSIFIER_CLASSIFIER_H_
#define GESTUS_MODELS_CLASSIFIER_CLASSIFIER_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "models/blocks/weights.h"
#include "models/network.h"
#include "models/normalisation.h"

namespace gestus::models {

struct ClassifierConfig {
  std::int64_t frames = 16;
  std::int64_t d_in = 52;  ///< pose and face
  std::int64_t layers = 3, hidden = 800;
  double frame_rate = 15.0;
  Normalisation motion;
};

struct ClassifierWeights {
  std::vector<LstmWeights> lstm;
  LinearWeights dense;  // (1, hidden)
};

/// motion (frames, d_in) -> (1, 1), 0 to 1.
Value Classifier(Graph& g, const ClassifierWeights& w, Value motion);

/// Input `motion` (frames, d_in), output `strength` (segments,).
Result<std::unique_ptr<Network>> MakeClassifierNetwork(std::shared_ptr<const WeightsFile> file,
                                                       const std::string& name,
                                                       const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_CLASSIFIER_CLASSIFIER_H_
