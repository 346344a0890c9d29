// How far styles are from one another, in all and part by part.
#ifndef GESTUS_MODELS_STYLES_DISTANCE_H_
#define GESTUS_MODELS_STYLES_DISTANCE_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/styles/style.h"

namespace gestus::styles {

/// Euclidean length.
double Norm(std::span<const float> x);
/// 1 - x . y / (|x| |y|), 0 to 2; nothing where one of them is 0.
std::optional<double> CosineDistance(std::span<const float> x, std::span<const float> y);
/// |x - y|
double EuclideanDistance(std::span<const float> x, std::span<const float> y);

/// The values of one part, which live in `style`.
std::span<const float> ValuesOf(const Style& style, const Part& part);
std::span<const float> ValuesOf(Style&&, const Part&) = delete;

/// The same of every style.
using Rows = std::vector<std::span<const float>>;
Rows RowsOf(const std::vector<Named>& styles, const Part& part);
Rows RowsOf(std::vector<Named>&&, const Part&) = delete;

/// The whole style as a part, "style", and behind it the parts that the first style that knows them
/// has.
std::vector<Part> WholeAndParts(const std::vector<Named>& styles);

}  // namespace gestus::styles

#endif  // GESTUS_MODELS_STYLES_DISTANCE_H_
