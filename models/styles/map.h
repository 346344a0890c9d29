// Styles as points in the plane, so that people can look at them (thesis Figure 6.6).
#ifndef GESTUS_MODELS_STYLES_MAP_H_
#define GESTUS_MODELS_STYLES_MAP_H_

#include <array>
#include <cstddef>
#include <vector>

#include "models/styles/distance.h"

namespace gestus::styles {

using Points = std::vector<std::array<double, 2>>;

struct PrincipalMap {
  Points points;
  std::array<double, 2> explained = {};  ///< share of the variance along each axis
};
/// The first two principal components of `rows`; of each the largest coordinate is positive.  What
/// has no variance is 0.
PrincipalMap MapByComponents(const Rows& rows);

struct NeighbourMap {
  Points points;
  double perplexity = 0;
  double divergence = 0;  ///< Kullback and Leibler's, which the map makes as small as it can
};
/// t-SNE (van der Maaten and Hinton 2008), exact, from the principal components and without chance:
/// the same rows give the same map.  Perplexity is 30, or (rows - 1) / 3 where that is less; for at
/// least 4 rows.  Time grows with the square of the rows.
NeighbourMap MapByNeighbours(const Rows& rows);

}  // namespace gestus::styles

#endif  // GESTUS_MODELS_STYLES_MAP_H_
