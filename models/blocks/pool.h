// How the rows of a sequence become one.
#ifndef GESTUS_MODELS_BLOCKS_POOL_H_
#define GESTUS_MODELS_BLOCKS_POOL_H_

#include "engine/graph.h"

namespace gestus::models {

enum class StylePool { kMean, kFirst, kLast };

/// x (T, D) -> (1, D).
inline Value Pool(Graph& g, StylePool pool, Value x) {
  if (pool == StylePool::kMean) return g.MeanRows(x);
  return g.Rows(x, pool == StylePool::kFirst ? 0 : g.shape(x).Rows() - 1, 1);
}

}  // namespace gestus::models

#endif  // GESTUS_MODELS_BLOCKS_POOL_H_
