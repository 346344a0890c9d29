// Reads and checks Model 2's configuration, and binds its tensors.
#include "models/config.h"

#include <algorithm>
#include <cmath>

#include "models/blocks/weights.h"
#include "models/model2/model2.h"
#include "weights_generated.h"

namespace gestus::models {

std::int64_t Model2Config::Stacks() const {
  std::int64_t stacks = 0;
  for (const Channel& channel : channels) stacks = std::max(stacks, channel.stack + 1);
  return stacks;
}

std::int32_t Model2Config::F0Token(float hz) const {
  if (!(hz > 0)) return 0;
  const double level = std::floor((double{hz} - double{f0_minimum}) / double{f0_step} + 0.5);
  return static_cast<std::int32_t>(std::clamp(level, 1.0, static_cast<double>(f0_tokens - 1)));
}

Result<Model2Config> ReadModel2Config(const fb::Model2Config& f, const std::string& where) {
  ConfigReader read(where);
  Model2Config c;
  c.max_words = read.Size("max_words", f.max_words(), 1, 1 << 10);
  c.f0_length = read.Size("f0_length", f.f0_length(), 1, 1 << 12);
  c.f0_minimum = f.f0_minimum();
  c.f0_step = f.f0_step();
  if (!(c.f0_step > 0 && c.f0_step < 1e6f))
    read.Fail("f0_step", std::to_string(c.f0_step), "a positive distance in Hz");
  if (!(std::fabs(c.f0_minimum) < 1e6f))
    read.Fail("f0_minimum", std::to_string(c.f0_minimum), "a frequency in Hz");
  c.f0_tokens = read.Size("f0_tokens", f.f0_tokens(), 2, 1 << 20);
  c.d_text = read.Size("d_text", f.d_text(), 1, 1 << 14);
  c.d_model = read.Size("d_model", f.d_model(), 1, 1 << 12);
  c.convolutions = read.Size("convolutions", f.convolutions(), 1, 16);
  c.kernel = read.Size("kernel", f.kernel(), 1, 63);
  if (c.kernel % 2 == 0) read.Fail("kernel", std::to_string(c.kernel), "an odd number of frames");
  c.encoder_layers = read.Size("encoder_layers", f.encoder_layers(), 0, 64);
  c.encoder_heads = read.Divisor("encoder_heads", f.encoder_heads(), c.d_model, "d_model");
  c.encoder_ff = read.Size("encoder_ff", f.encoder_ff(), 1, 1 << 14);
  c.master = read.Enum<Master>("master", f.master(), fb::Master::MAX);
  c.attention_heads = read.Divisor("attention_heads", f.attention_heads(), c.d_model, "d_model");
  c.attention_ff = read.Size("attention_ff", f.attention_ff(), 1, 1 << 14);
  c.attention_width = f.attention_width();
  const bool as_text = c.master == Master::kText && c.attention_width == c.d_text;
  if (c.attention_width != c.d_model && !as_text)
    read.Fail("attention_width", std::to_string(c.attention_width),
              "d_model, or d_text with the text as master");
  c.decoder_layers = read.Size("decoder_layers", f.decoder_layers(), 1, 64);
  c.decoder_heads = read.Divisor("decoder_heads", f.decoder_heads(), c.d_model, "d_model");
  c.decoder_ff = read.Size("decoder_ff", f.decoder_ff(), 1, 1 << 14);
  c.conv_decoder = f.conv_decoder();
  c.shared_norm = f.shared_norm();
  c.scaled = read.Enum<int>("scale", f.scale(), fb::AttentionScale::MAX) != 0;
  c.ln_eps = read.Epsilon("ln_eps", f.ln_eps());
  c.max_out = read.Size("max_out", f.max_out(), 1, 1 << 12);
  for (const fb::Channel* channel : *f.channels()) ReadChannel(read, *channel, &c.channels);
  if (c.channels.empty()) read.Fail("channels", "none", "one or more");
  if (!read.status().ok()) return read.status();

  std::vector<std::int64_t> tokens(static_cast<std::size_t>(c.Stacks()), 0);
  for (const Channel& channel : c.channels) {
    std::int64_t& of_stack = tokens[static_cast<std::size_t>(channel.stack)];
    if (of_stack != 0 && of_stack != channel.Tokens())
      read.Fail("channels: levels", std::to_string(channel.levels),
                "those of the other channels of its stack");
    of_stack = channel.Tokens();
  }
  if (std::count(tokens.begin(), tokens.end(), 0) > 0)
    read.Fail("channels: stack", "some number unused", "stacks numbered from 0 without a gap");
  if (!read.status().ok()) return read.status();
  return c;
}

namespace {

void BindAttention(Binder& binder, const std::string& name, std::int64_t d, std::int64_t memory,
                   AttentionWeights* w) {
  BindLinear(binder, name + ".query", d, d, &w->query);
  BindLinear(binder, name + ".key", d, memory, &w->key);
  BindLinear(binder, name + ".value", d, memory, &w->value);
  BindLinear(binder, name + ".out", d, d, &w->out);
}

void BindEncoderLayer(Binder& binder, const Model2Config& c, std::int64_t ff,
                      Model2Weights::Layer* w) {
  BindAttention(binder, "self_attn", c.d_model, c.d_model, &w->self_attn);
  BindNorm(binder, "norm1", c.d_model, c.ln_eps, &w->norm1);
  BindNorm(binder, "norm2", c.d_model, c.ln_eps, &w->norm2);
  BindLinear(binder, "linear1", ff, c.d_model, &w->linear1);
  BindLinear(binder, "linear2", c.d_model, ff, &w->linear2);
}

/// `memory` is the width of what its cross-attention looks at.
void BindDecoderLayer(Binder& binder, const Model2Config& c, std::int64_t memory, std::int64_t ff,
                      Model2Weights::Layer* w) {
  BindAttention(binder, "self_attn", c.d_model, c.d_model, &w->self_attn);
  BindAttention(binder, "cross_attn", c.d_model, memory, &w->cross_attn);
  BindNorm(binder, "norm1", c.d_model, c.ln_eps, &w->norm1);
  w->norm2 = w->norm1;
  if (!c.shared_norm) BindNorm(binder, "norm2", c.d_model, c.ln_eps, &w->norm2);
  BindNorm(binder, "norm3", c.d_model, c.ln_eps, &w->norm3);
  BindLinear(binder, "linear1", ff, c.d_model, &w->linear1);
  BindLinear(binder, "linear2", c.d_model, ff, &w->linear2);
}

/// `name`.0, .1, ...: convolutions whose first one takes `in` columns.
void BindConvolutions(Binder& binder, const Model2Config& c, const std::string& name,
                      std::int64_t in, std::vector<LinearWeights>* w) {
  w->resize(static_cast<std::size_t>(c.convolutions));
  for (std::size_t i = 0; i < w->size(); ++i) {
    const std::string layer = name + "." + std::to_string(i);
    binder.Bind({{layer + ".weight",
                  &(*w)[i].weight,
                  {c.d_model, i == 0 ? in : c.d_model, c.kernel},
                  Binder::kProduct},
                 {layer + ".bias", &(*w)[i].bias, {c.d_model}}});
  }
}

}  // namespace

void BindModel2(Binder& binder, const Model2Config& c, Model2Weights* w) {
  const std::int64_t d = c.d_model;
  binder.Bind(
      {{"f0_encoder.embedding.weight", &w->f0_embedding, {c.f0_tokens, d}, Binder::kProduct}});
  BindConvolutions(binder, c, "f0_encoder.conv", d, &w->f0_conv);
  w->encoder.resize(static_cast<std::size_t>(c.encoder_layers));
  for (std::size_t i = 0; i < w->encoder.size(); ++i) {
    const Binder::Scope scope(binder, "encoder.layers." + std::to_string(i) + ".");
    BindEncoderLayer(binder, c, c.encoder_ff, &w->encoder[i]);
  }
  const bool by_text = c.master == Master::kText;
  if (by_text) BindLinear(binder, "cross.text_projection", d, c.d_text, &w->text_projection);
  {
    const Binder::Scope scope(binder, "cross.layer.");
    BindDecoderLayer(binder, c, by_text ? d : c.d_text, c.attention_ff, &w->cross);
  }
  if (c.attention_width != d)
    BindLinear(binder, "cross.output", c.attention_width, d, &w->cross_output);

  w->decoders.resize(static_cast<std::size_t>(c.Stacks()));
  for (const Channel& channel : c.channels) {
    Model2Weights::Stack& stack = w->decoders[static_cast<std::size_t>(channel.stack)];
    if (!stack.layers.empty()) continue;  // bound for an earlier channel
    const Binder::Scope scope(binder, "decoders." + std::to_string(channel.stack) + ".");
    binder.Bind({{"embedding.weight", &stack.embedding, {channel.Tokens(), d}, Binder::kProduct}});
    stack.layers.resize(static_cast<std::size_t>(c.decoder_layers));
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
      const Binder::Scope layer(binder, "layers." + std::to_string(i) + ".");
      BindDecoderLayer(binder, c, c.attention_width, c.decoder_ff, &stack.layers[i]);
    }
  }
  const auto channels = static_cast<std::int64_t>(c.channels.size());
  if (c.conv_decoder) BindConvolutions(binder, c, "conv_decoder", channels * d, &w->conv_decoder);
  w->heads.resize(c.channels.size());
  for (std::size_t n = 0; n < w->heads.size(); ++n)
    BindLinear(binder, "heads." + std::to_string(n), c.channels[n].Tokens(), d, &w->heads[n]);
}

}  // namespace gestus::models
