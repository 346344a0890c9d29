// Model 2 with the tokens of all positions given, as in training: what one pass of its decoders
// costs, in the engines that have no loop too.  d = d_model, T = positions.
#include <cmath>
#include <string>

#include "bench/peers/networks.h"
#include "models/blocks/attention.h"

namespace gestus::bench {

using namespace models;  // NOLINT: this file declares one of the models

namespace {

AttentionOptions Heads(const Model2Config& c, bool causal) {
  return {.heads = static_cast<int>(c.decoder_heads),
          .scale = c.scaled ? 0.0f : 1.0f,
          .causal = causal};
}

/// Post-norm decoder layer (Vaswani et al. 2017), x (T, d).
Value DecoderLayer(Graph& g, const Model2Config& c, const Model2Weights::Layer& w, Value x,
                   Value h_att) {
  x = g.LayerNorm(g.Add(x, MultiHead(g, w.self_attn, Heads(c, true), x, x)), w.norm1);
  x = g.LayerNorm(g.Add(x, MultiHead(g, w.cross_attn, Heads(c, false), x, h_att)), w.norm2);
  const Value ff = g.Linear(g.Linear(x, w.linear1, Activation::kRelu), w.linear2);
  return g.LayerNorm(g.Add(x, ff), w.norm3);
}

}  // namespace

Graph Model2Pass(const Model2Config& c, const Model2Weights& w, const InputSize& size) {
  Graph g;
  const auto channels = static_cast<std::int64_t>(c.channels.size());
  const std::int64_t steps = size("tokens") / channels, words = size("text") / c.d_text;
  const Value f0 = g.Input("f0", {c.max_words * c.f0_length}, DType::kI32);
  const Value text = g.Input("text", {words, c.d_text});
  const Value tokens = g.Input("tokens", {channels, steps}, DType::kI32);

  const Value h_att = CrossModality(g, c, w, F0Encoder(g, c, w, f0), text);  // (words, d)
  const Value positions = g.Positions(steps, c.d_model);
  const float root = std::sqrt(static_cast<float>(c.d_model));
  std::vector<Value> rows;
  for (std::int64_t n = 0; n < channels; ++n) {
    const auto& stack =
        w.decoders[static_cast<std::size_t>(c.channels[static_cast<std::size_t>(n)].stack)];
    const Value ids = g.Reshape(g.Rows(tokens, n, 1), {steps});
    Value x = g.Add(g.Embedding(ids, stack.embedding, root), positions);
    for (const Model2Weights::Layer& layer : stack.layers) x = DecoderLayer(g, c, layer, x, h_att);
    rows.push_back(x);  // (T, d)
  }
  if (c.conv_decoder) {
    Value x = g.Concat(rows);
    for (const LinearWeights& conv : w.conv_decoder)
      x = g.Conv1d(x, conv, 1, c.kernel / 2, c.kernel / 2, Activation::kRelu);
    rows.assign(rows.size(), x);
  }
  for (std::size_t n = 0; n < rows.size(); ++n)
    g.Output("logits." + std::to_string(n), g.Linear(rows[n], w.heads[n]));
  return g;
}

}  // namespace gestus::bench
