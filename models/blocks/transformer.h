// torch.nn.MultiheadAttention and torch.nn.TransformerDecoderLayer as graphs.
#ifndef GESTUS_MODELS_BLOCKS_TRANSFORMER_H_
#define GESTUS_MODELS_BLOCKS_TRANSFORMER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/binder.h"
#include "engine/graph.h"

namespace gestus::models {

struct MultiheadWeights {
  LinearWeights in_proj;   // (3E, E): queries, keys, values
  LinearWeights out_proj;  // (E, E)
};

/// Post-norm decoder layer (Vaswani et al. 2017, figure 1).
struct DecoderLayerWeights {
  MultiheadWeights self_attn, cross_attn;
  LinearWeights linear1, linear2;  // (FF, E), (E, FF)
  NormWeights norm1, norm2, norm3;
};

void BindMultihead(Binder& binder, const std::string& name, std::int64_t e, MultiheadWeights* w);
void BindDecoderLayer(Binder& binder, const std::string& name, std::int64_t e, std::int64_t ff,
                      float ln_eps, DecoderLayerWeights* w);

/// Self-attention of x (T, E) with its output projection; no residual, no norm.
Value SelfAttention(Graph& g, const MultiheadWeights& w, int heads, Value x, bool causal = false);

/// Keys and values of `memory` for a layer's cross-attention, (Tm, 2E): they do not change over
/// steps.
Value MemoryKeysValues(Graph& g, const DecoderLayerWeights& w, Value memory);

/// All positions at once: x (T, E), causal self-attention.
Value DecoderLayer(Graph& g, const DecoderLayerWeights& w, int heads, Value x, Value memory_kv);

/// One position inside a loop; `cache` (T, 2E) holds the keys and values of the positions so far.
Value DecoderLayerStep(Graph& g, const DecoderLayerWeights& w, int heads, Value x, Value memory_kv,
                       Value cache);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_BLOCKS_TRANSFORMER_H_
