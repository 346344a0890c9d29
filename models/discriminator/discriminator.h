// Dis (thesis 6.5.4): predicts h_style from h_content.  Training pushes the encoder until it fails;
// afterwards its error tells how much style has stayed in the content.
#ifndef GESTUS_MODELS_DISCRIMINATOR_DISCRIMINATOR_H_
#define GESTUS_MODELS_DISCRIMINATOR_DISCRIMINATOR_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "models/blocks/pool.h"
#include "models/blocks/weights.h"
#include "models/network.h"

namespace gestus::models {

struct DiscriminatorConfig {
  std::int64_t rows = 64;  ///< of h_content
  std::int64_t d_content = 1536, d_style = 2304;
  StylePool pool = StylePool::kMean;
  std::int64_t layers = 1, hidden = 512;
  float alpha = 0.2f;  ///< of LeakyReLU
};

struct DiscriminatorWeights {
  std::vector<LinearWeights> layers;
  LinearWeights output;  // (d_style, hidden)
};

/// h_content (rows, d_content) -> h_style^ (1, d_style).
Value Discriminator(Graph& g, const DiscriminatorConfig& c, const DiscriminatorWeights& w,
                    Value h_content);

/// Input `content` (rows, d_content), output `style` (segments, d_style).
Result<std::unique_ptr<Network>> MakeDiscriminatorNetwork(std::shared_ptr<const WeightsFile> file,
                                                          const std::string& name,
                                                          const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_DISCRIMINATOR_DISCRIMINATOR_H_
