// Transformer blocks.  E is the width, T the positions, Tm those of the memory.
#include "models/blocks/transformer.h"

#include "models/blocks/weights.h"

namespace gestus::models {
namespace {

std::int64_t Width(const MultiheadWeights& w) { return w.out_proj.weight.shape[0]; }

/// What follows self-attention `att` (T, E), its output projection included.
Value AfterSelfAttention(Graph& g, const DecoderLayerWeights& w, int heads, Value x, Value att,
                         Value memory_kv) {
  const std::int64_t e = Width(w.cross_attn);
  x = g.LayerNorm(g.Add(x, g.Linear(att, w.self_attn.out_proj)), w.norm1);  // (T, E)
  const Value q = g.Linear(x, RowsOf(w.cross_attn.in_proj, 0, e));          // (T, E)
  att = g.Attention(q, g.Columns(memory_kv, 0, e), g.Columns(memory_kv, e, e), {.heads = heads});
  x = g.LayerNorm(g.Add(x, g.Linear(att, w.cross_attn.out_proj)), w.norm2);
  const Value hidden = g.Linear(x, w.linear1, Activation::kRelu);  // (T, FF)
  return g.LayerNorm(g.Add(x, g.Linear(hidden, w.linear2)), w.norm3);
}

}  // namespace

void BindMultihead(Binder& binder, const std::string& name, std::int64_t e, MultiheadWeights* w) {
  binder.Bind({
      {name + ".in_proj_weight", &w->in_proj.weight, {3 * e, e}, Binder::kProduct},
      {name + ".in_proj_bias", &w->in_proj.bias, {3 * e}},
  });
  BindLinear(binder, name + ".out_proj", e, e, &w->out_proj);
}

void BindDecoderLayer(Binder& binder, const std::string& name, std::int64_t e, std::int64_t ff,
                      float ln_eps, DecoderLayerWeights* w) {
  const Binder::Scope scope(binder, name + ".");
  BindMultihead(binder, "self_attn", e, &w->self_attn);
  BindMultihead(binder, "multihead_attn", e, &w->cross_attn);
  BindLinear(binder, "linear1", ff, e, &w->linear1);
  BindLinear(binder, "linear2", e, ff, &w->linear2);
  BindNorm(binder, "norm1", e, ln_eps, &w->norm1);
  BindNorm(binder, "norm2", e, ln_eps, &w->norm2);
  BindNorm(binder, "norm3", e, ln_eps, &w->norm3);
}

Value SelfAttention(Graph& g, const MultiheadWeights& w, int heads, Value x, bool causal) {
  const std::int64_t e = Width(w);
  const Value qkv = g.Linear(x, w.in_proj);  // (T, 3E)
  const Value att = g.Attention(g.Columns(qkv, 0, e), g.Columns(qkv, e, e),
                                g.Columns(qkv, 2 * e, e), {.heads = heads, .causal = causal});
  return g.Linear(att, w.out_proj);  // (T, E)
}

Value MemoryKeysValues(Graph& g, const DecoderLayerWeights& w, Value memory) {
  const std::int64_t e = Width(w.cross_attn);
  return g.Linear(memory, RowsOf(w.cross_attn.in_proj, e, 2 * e));  // (Tm, 2E)
}

Value DecoderLayer(Graph& g, const DecoderLayerWeights& w, int heads, Value x, Value memory_kv) {
  const std::int64_t e = Width(w.self_attn);
  const Value qkv = g.Linear(x, w.self_attn.in_proj);  // (T, 3E)
  const Value att = g.Attention(g.Columns(qkv, 0, e), g.Columns(qkv, e, e),
                                g.Columns(qkv, 2 * e, e), {.heads = heads, .causal = true});
  return AfterSelfAttention(g, w, heads, x, att, memory_kv);
}

Value DecoderLayerStep(Graph& g, const DecoderLayerWeights& w, int heads, Value x, Value memory_kv,
                       Value cache) {
  const std::int64_t e = Width(w.self_attn);
  const Value qkv = g.Linear(x, w.self_attn.in_proj);  // (1, 3E)
  g.StoreRows(cache, g.Columns(qkv, e, 2 * e));
  const Value att = g.Attention(g.Columns(qkv, 0, e), g.Columns(cache, 0, e),
                                g.Columns(cache, e, e), {.heads = heads, .by_step = true});
  return AfterSelfAttention(g, w, heads, x, att, memory_kv);
}

}  // namespace gestus::models
