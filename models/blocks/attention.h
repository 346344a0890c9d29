// Multi-head attention with a matrix for each of queries, keys, values and output (BERT, Keras).
#ifndef GESTUS_MODELS_BLOCKS_ATTENTION_H_
#define GESTUS_MODELS_BLOCKS_ATTENTION_H_

#include "engine/binder.h"
#include "engine/graph.h"

namespace gestus::models {

struct AttentionWeights {
  LinearWeights query, key, value;  // (D, width of what they look at)
  LinearWeights out;                // (D, D)
};

/// Rows of x ask rows of `memory`, which may be x itself -> (T, D), projected.
inline Value MultiHead(Graph& g, const AttentionWeights& w, const AttentionOptions& options,
                       Value x, Value memory) {
  const Value q = g.Linear(x, w.query), k = g.Linear(memory, w.key), v = g.Linear(memory, w.value);
  return g.Linear(g.Attention(q, k, v, options), w.out);
}

}  // namespace gestus::models

#endif  // GESTUS_MODELS_BLOCKS_ATTENTION_H_
