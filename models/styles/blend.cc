#include "models/styles/blend.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"

namespace gestus::styles {
namespace {

constexpr double kMaxWeight = 1000;
constexpr std::size_t kMaxSources = 4096;
// Written weights that are meant to add up to one do so within this.
constexpr double kRounding = 1e-6;

Result<double> SumOfWeights(const std::vector<Ingredient>& ingredients) {
  double sum = 0;
  for (const Ingredient& ingredient : ingredients) {
    if (!(std::fabs(ingredient.weight) <= kMaxWeight))
      return Status(Code::kInvalidArgument, ingredient.from.name + ": weight " +
                                                Significant(ingredient.weight, 6) +
                                                ", expected -1000 to 1000");
    sum += ingredient.weight;
  }
  if (sum > kRounding) return sum;
  return Status(Code::kInvalidArgument,
                "weights: add up to " + Significant(sum, 6) + ", expected a sum above 0");
}

void AddSources(const Named& from, double share, std::vector<Source>* sources) {
  if (share == 0) return;
  for (const Source& source : from.style.made_of)
    sources->push_back({source.name, share * source.share, source.segments});
  if (from.style.made_of.empty()) sources->push_back({from.name, share, 0});
}

}  // namespace

Result<Blend> MakeBlend(const std::vector<Ingredient>& ingredients) {
  if (ingredients.empty())
    return Status(Code::kInvalidArgument, "styles: none, expected one at least");
  std::vector<Named> styles;
  for (const Ingredient& ingredient : ingredients) styles.push_back(ingredient.from);
  GESTUS_RETURN_IF_ERROR(CheckAlike(styles));
  const Result<double> sum = SumOfWeights(ingredients);
  if (!sum.ok()) return sum.status();
  Blend blend;
  blend.style = styles.front().style;
  blend.style.made_of.clear();
  std::vector<double> values(blend.style.values.size());
  for (const Ingredient& ingredient : ingredients) {
    const Style& style = ingredient.from.style;
    const double share = ingredient.weight / *sum;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += share * style.values[i];
    if (blend.style.network.empty()) blend.style.network = style.network;
    if (blend.style.parts.empty()) blend.style.parts = style.parts;
    AddSources(ingredient.from, share, &blend.style.made_of);
  }
  if (blend.style.made_of.size() > kMaxSources)
    return Status(Code::kResourceExhausted, "styles: made of " +
                                                std::to_string(blend.style.made_of.size()) +
                                                " clips, expected at most 4096");
  for (std::size_t i = 0; i < values.size(); ++i) {
    blend.style.values[i] = static_cast<float>(values[i]);
    if (!std::isfinite(blend.style.values[i]))
      return Status(Code::kNonFinite, "style: value " + std::to_string(i) +
                                          " leaves the range of float32, expected smaller weights");
  }
  if (std::fabs(*sum - 1) > kRounding)
    blend.notes.push_back("the weights add up to " + Significant(*sum, 4) +
                          ": each was divided by that");
  if (std::any_of(ingredients.begin(), ingredients.end(),
                  [](const Ingredient& i) { return i.weight < 0; }))
    blend.notes.push_back("a weight below 0 leads away from that style, where nobody has been");
  return blend;
}

}  // namespace gestus::styles
