// Model 2 as a graph.  d = d_model, W = max_words, L = f0_length, T = max_out.
#include "models/model2/model2.h"

#include <cmath>

namespace gestus::models {
namespace {

using Layer = Model2Weights::Layer;

float RootOf(std::int64_t d) { return std::sqrt(static_cast<float>(d)); }

/// Softmax(Q K^T) V, eq. 5.12, without a scale unless the configuration has one.
AttentionOptions Heads(const Model2Config& c, std::int64_t heads) {
  return {.heads = static_cast<int>(heads), .scale = c.scaled ? 0.0f : 1.0f};
}

Value FeedForward(Graph& g, const Layer& w, Value x) {
  return g.Linear(g.Linear(x, w.linear1, Activation::kRelu), w.linear2);
}

/// Keys and values of what a layer looks at.
struct Memory {
  Value keys, values;
};

Memory Remember(Graph& g, const AttentionWeights& w, Value memory) {
  return {g.Linear(memory, w.key), g.Linear(memory, w.value)};
}

/// What follows self-attention, `att` being projected already.
Value AfterSelfAttention(Graph& g, const AttentionOptions& options, const Layer& w, Value x,
                         Value att, const Memory& memory) {
  x = g.LayerNorm(g.Add(x, att), w.norm1);
  att = g.Attention(g.Linear(x, w.cross_attn.query), memory.keys, memory.values, options);
  x = g.LayerNorm(g.Add(x, g.Linear(att, w.cross_attn.out)), w.norm2);
  return g.LayerNorm(g.Add(x, FeedForward(g, w, x)), w.norm3);
}

}  // namespace

Value F0Encoder(Graph& g, const Model2Config& c, const Model2Weights& w, Value f0) {
  const std::int64_t d = c.d_model, rows = c.max_words * c.f0_length, pad = c.kernel / 2;
  // E1_speech: the contour of each word.
  Value x = g.Reshape(g.Embedding(f0, w.f0_embedding), {c.max_words, c.f0_length, d});
  for (const LinearWeights& conv : w.f0_conv) x = g.Conv1d(x, conv, 1, pad, pad, Activation::kRelu);
  const std::vector<float> scale(static_cast<std::size_t>(d), RootOf(d)), zero(scale.size(), 0.0f);
  const Value positions = g.Positions(c.f0_length, d);
  const std::vector<Value> of_each_word(static_cast<std::size_t>(c.max_words), positions);
  x = g.Add(g.Affine(g.Reshape(x, {rows, d}), scale, zero), g.ConcatRows(of_each_word));
  {
    const Graph::Scope scope(g, "f0_encoder");
    g.Tap("out", x);
  }
  // E2_speech: attention among the values of a word.
  x = g.Reshape(x, {c.max_words, c.f0_length, d});
  const AttentionOptions options = Heads(c, c.encoder_heads);
  for (std::size_t i = 0; i < w.encoder.size(); ++i) {
    const Graph::Scope scope(g, "encoder." + std::to_string(i));
    const Layer& layer = w.encoder[i];
    x = g.LayerNorm(g.Add(x, MultiHead(g, layer.self_attn, options, x, x)), layer.norm1);
    x = g.LayerNorm(g.Add(x, FeedForward(g, layer, x)), layer.norm2);
    g.Tap("out", x);
  }
  return g.Reshape(x, {rows, d});
}

Value CrossModality(Graph& g, const Model2Config& c, const Model2Weights& w, Value speech,
                    Value text) {
  const Graph::Scope scope(g, "cross");
  AttentionOptions causal = Heads(c, c.attention_heads);
  causal.causal = true;
  // The master asks.  With speech as master each word's row of text would stand f0_length times
  // among the keys; equal keys share their weight, so once is the same.
  const bool by_text = c.master == Master::kText;
  Value x = by_text ? g.Linear(text, w.text_projection) : speech;
  const Value slave = by_text ? speech : text;
  const Value att = MultiHead(g, w.cross.self_attn, causal, x, x);
  x = AfterSelfAttention(g, Heads(c, c.attention_heads), w.cross, x, att,
                         Remember(g, w.cross.cross_attn, slave));
  if (c.attention_width != c.d_model) x = g.Add(text, g.Linear(x, w.cross_output));
  g.Tap("out", x);
  return x;
}

namespace {

/// D2_face of one channel: a stack of decoder layers that keeps what it has seen.
class ChannelDecoder {
 public:
  /// Before the loop.
  ChannelDecoder(Graph& g, const Model2Config& c, const Model2Weights::Stack& w, Value h_att)
      : c_(c), w_(w), tokens_(g.Buffer({c.max_out, 1}, DType::kI32)) {
    for (const Layer& layer : w.layers) {
      memory_.push_back(Remember(g, layer.cross_attn, h_att));
      cache_.push_back({g.Buffer({c.max_out, c.d_model}), g.Buffer({c.max_out, c.d_model})});
    }
  }

  /// One step: the token before this one -> (1, d).
  Value Step(Graph& g, Value start, Value position) const {
    const Value token = g.PreviousRow(tokens_, start);
    Value x = g.Add(g.Embedding(token, w_.embedding, RootOf(c_.d_model)), position);
    const AttentionOptions options = Heads(c_, c_.decoder_heads);
    AttentionOptions by_step = options;
    by_step.by_step = true;
    for (std::size_t i = 0; i < w_.layers.size(); ++i) {
      const AttentionWeights& self = w_.layers[i].self_attn;
      g.StoreRows(cache_[i].keys, g.Linear(x, self.key));
      g.StoreRows(cache_[i].values, g.Linear(x, self.value));
      const Value att =
          g.Attention(g.Linear(x, self.query), cache_[i].keys, cache_[i].values, by_step);
      x = AfterSelfAttention(g, options, w_.layers[i], x, g.Linear(att, self.out), memory_[i]);
    }
    return x;
  }

  Value tokens() const { return tokens_; }

 private:
  const Model2Config& c_;
  const Model2Weights::Stack& w_;
  Value tokens_;
  std::vector<Memory> memory_, cache_;
};

/// D1_face by step: 'same' convolutions over the rows decoded so far.  A new row changes the
/// `kernel / 2` rows before it in every layer; what the last row needs of them is computed again.
class ConvDecoder {
 public:
  ConvDecoder(Graph& g, const Model2Config& c, const Model2Weights& w) : c_(c), w_(w) {
    for (const LinearWeights& conv : w.conv_decoder)
      rows_.push_back(g.Buffer({c.max_out, conv.weight.shape[1]}));
  }

  Value Step(Graph& g, Value x) const {
    const std::int64_t reach = c_.kernel / 2;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto left = static_cast<std::int64_t>(rows_.size() - i);
      g.StoreRows(rows_[i], x);
      x = g.Conv1d(g.LastRows(rows_[i], left * reach + 1), w_.conv_decoder[i], 1, 0, reach,
                   Activation::kRelu);
    }
    return x;  // (1, d)
  }

 private:
  const Model2Config& c_;
  const Model2Weights& w_;
  std::vector<Value> rows_;  // what goes into each layer
};

}  // namespace

std::vector<Value> FaceDecoder(Graph& g, const Model2Config& c, const Model2Weights& w, Value h_att,
                               Value controls, Value u) {
  static constexpr std::int32_t kStart[] = {kStartToken};
  const Value start = g.Constant({DType::kI32, {1, 1}, kStart});
  const Value positions = g.Positions(c.max_out, c.d_model);
  std::vector<ChannelDecoder> decoders;
  std::vector<Value> logits;
  for (const Channel& channel : c.channels) {
    decoders.emplace_back(g, c, w.decoders[static_cast<std::size_t>(channel.stack)], h_att);
    logits.push_back(g.Buffer({c.max_out, channel.Tokens()}));
  }
  const ConvDecoder conv(g, c, w);

  g.BeginLoop(c.max_out);
  const Value position = g.StepRow(positions), luck = g.StepRow(u);
  std::vector<Value> z;
  for (std::size_t n = 0; n < decoders.size(); ++n) {
    const Graph::Scope scope(g, "decoder." + c.channels[n].name);
    z.push_back(decoders[n].Step(g, start, position));
  }
  if (c.conv_decoder) {
    const Graph::Scope scope(g, "conv_decoder");
    z.assign(z.size(), conv.Step(g, g.Concat(z)));
  }
  for (std::size_t n = 0; n < decoders.size(); ++n) {
    const Graph::Scope scope(g, "head." + c.channels[n].name);
    const Value row = g.Linear(z[n], w.heads[n]);
    g.StoreRows(logits[n], row);
    g.StoreRows(decoders[n].tokens(),
                g.Pick(row, controls, g.Columns(luck, static_cast<std::int64_t>(n), 1)));
  }
  g.EndLoop();

  std::vector<Value> tokens;
  for (std::size_t n = 0; n < decoders.size(); ++n) {
    g.Tap("logits." + std::to_string(n), logits[n]);
    tokens.push_back(decoders[n].tokens());
  }
  return tokens;
}

}  // namespace gestus::models
