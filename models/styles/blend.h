// One style of several: clips of a speaker, or speakers.
#ifndef GESTUS_MODELS_STYLES_BLEND_H_
#define GESTUS_MODELS_STYLES_BLEND_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/styles/style.h"

namespace gestus::styles {

struct Ingredient {
  Named from;
  double weight = 1;  ///< -1000 to 1000
};

struct Blend {
  Style style;
  std::vector<std::string> notes;
};

/// The sum of weight / (sum of all weights) times each style.  Weights below 0 lead away from a
/// style.  `made_of` lists the clips of all styles with a weight, the style itself where its clips
/// are not known.  Errors: nothing to blend, styles that are not alike, weights without a positive
/// sum, values too large for float32, more than 4096 clips.
Result<Blend> MakeBlend(const std::vector<Ingredient>& ingredients);

}  // namespace gestus::styles

#endif  // GESTUS_MODELS_STYLES_BLEND_H_
