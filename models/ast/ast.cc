// AST as a graph.  T frames, F mel bins, D = d_model.
#include "models/ast/ast.h"

#include "models/blocks/weights.h"

namespace gestus::models {
namespace {

/// Pre-norm encoder block (Dosovitskiy et al. 2021, eq. 2-3) on x (N, D), of which only the first
/// `rows` are wanted: the others serve as keys and values alone.
Value EncoderBlock(Graph& g, const AstConfig& c, const AstWeights::Block& w, Value x,
                   std::int64_t rows) {
  const std::int64_t d = c.d_model;
  const Value in = g.LayerNorm(x, w.norm1);  // (N, D)
  Value q, kv;
  if (rows == g.shape(x)[0]) {
    const Value qkv = g.Linear(in, w.qkv);  // (N, 3D)
    q = g.Columns(qkv, 0, d);
    kv = g.Columns(qkv, d, 2 * d);
  } else {
    q = g.Linear(g.Rows(in, 0, rows), RowsOf(w.qkv, 0, d));  // (rows, D)
    kv = g.Linear(in, RowsOf(w.qkv, d, 2 * d));              // (N, 2D)
    x = g.Rows(x, 0, rows);
  }
  const Value att = g.Attention(q, g.Columns(kv, 0, d), g.Columns(kv, d, d),
                                {.heads = static_cast<int>(c.heads)});  // (rows, D)
  x = g.Add(x, g.Linear(att, w.proj));
  const Value hidden = g.Linear(g.LayerNorm(x, w.norm2), w.fc1, Activation::kGeluErf);
  return g.Add(x, g.Linear(hidden, w.fc2));  // (rows, D)
}

}  // namespace

Value Ast(Graph& g, const AstConfig& c, const AstWeights& w, Value x) {
  const Graph::Scope scope(g, "ast");
  const Value pos = g.Constant(w.positions);
  const Value patches = g.Linear(g.Patches(x, {c.patch, c.stride}), w.patch);  // (P, D)
  g.Tap("patches", patches);
  x = g.ConcatRows({g.Add(g.Constant(w.cls), g.Rows(pos, 0, 1)),
                    g.Add(g.Constant(w.dist), g.Rows(pos, 1, 1)),
                    g.Add(patches, g.Rows(pos, 2, c.Patches()))});  // (2 + P, D)

  // Pooling looks at the two tokens alone, so the last block computes no other row.
  const std::int64_t tokens = 2;
  for (std::size_t i = 0; i < w.blocks.size(); ++i) {
    const Graph::Scope block(g, "block." + std::to_string(i));
    const bool last = i + 1 == w.blocks.size();
    x = EncoderBlock(g, c, w.blocks[i], x, last ? tokens : tokens + c.Patches());
    g.Tap("out", x);
  }
  x = g.LayerNorm(g.Rows(x, 0, tokens), w.norm);  // (2, D)
  g.Tap("norm", x);

  x = c.pool == AstPool::kCls ? g.Rows(x, 0, 1) : g.MeanRows(x);  // (1, D)
  if (c.head == AstHead::kLayerNormLinear) x = g.LayerNorm(x, w.head_norm);
  if (c.head != AstHead::kNone) x = g.Linear(x, w.head);  // (1, d_out)
  g.Tap("out", x);
  return x;
}

}  // namespace gestus::models
