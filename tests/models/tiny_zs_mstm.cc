// The tensors by PyTorch's names, as docs/format.md and the thesis' modules have them.
#include "tests/models/tiny_zs_mstm.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/run_support.h"
#include "tests/engine/dense.h"

namespace gestus::test {
namespace {

using Dims = std::vector<std::uint32_t>;

class Maker {
 public:
  explicit Maker(FileSpec* file) : file_(file) {}

  void Add(const std::string& name, Dims shape) {
    std::int64_t n = 1;
    for (std::uint32_t d : shape) n *= d;
    TensorSpec t{name, std::move(shape), Noise(n, ++seed_)};
    // Sums of products stay near 1.
    const float scale = 1.0f / std::sqrt(static_cast<float>(t.shape.back()));
    for (float& v : t.values) v *= scale;
    file_->tensors.push_back(std::move(t));
  }
  void Linear(const std::string& name, std::uint32_t out, std::uint32_t in) {
    Add(name + ".weight", {out, in});
    Add(name + ".bias", {out});
  }
  void Norm(const std::string& name, std::uint32_t d) {
    Add(name + ".weight", {d});
    Add(name + ".bias", {d});
  }
  void Multihead(const std::string& name, std::uint32_t e) {
    Add(name + ".in_proj_weight", {3 * e, e});
    Add(name + ".in_proj_bias", {3 * e});
    Linear(name + ".out_proj", e, e);
  }
  void Ast(const std::string& at, const TinyAst& c) {
    const std::uint32_t d = c.d_model, p = c.patch;
    const std::uint32_t patches =
        ((c.frames - p) / c.stride + 1) * ((c.mel_bins - p) / c.stride + 1);
    Add(at + "v.cls_token", {1, 1, d});
    Add(at + "v.dist_token", {1, 1, d});
    Add(at + "v.pos_embed", {1, 2 + patches, d});
    Add(at + "v.patch_embed.proj.weight", {d, 1, p, p});
    Add(at + "v.patch_embed.proj.bias", {d});
    for (std::uint32_t i = 0; i < c.layers; ++i) {
      const std::string block = at + "v.blocks." + std::to_string(i) + ".";
      Norm(block + "norm1", d);
      Linear(block + "attn.qkv", 3 * d, d);
      Linear(block + "attn.proj", d, d);
      Norm(block + "norm2", d);
      Linear(block + "mlp.fc1", c.d_mlp, d);
      Linear(block + "mlp.fc2", d, c.d_mlp);
    }
    Norm(at + "v.norm", d);
    if (c.head == fb::AstHead::LayerNormLinear) Norm(at + "mlp_head.0", d);
    if (c.head != fb::AstHead::None) Linear(at + "mlp_head.1", c.d_out, d);
  }

 private:
  FileSpec* file_;
  std::uint32_t seed_ = 1000;
};

flatbuffers::Offset<fb::AstConfig> AddAst(flatbuffers::FlatBufferBuilder& b, const TinyAst& c) {
  return fb::CreateAstConfig(b, c.frames, c.mel_bins, c.patch, c.stride, c.d_model, c.layers,
                             c.heads, c.d_mlp, c.pool, c.head, c.d_out, c.ln_eps, c.head_ln_eps);
}

}  // namespace

flatbuffers::Offset<void> TinyZsMstm::Config(flatbuffers::FlatBufferBuilder& b) const {
  const auto ast_content = AddAst(b, content);
  flatbuffers::Offset<fb::AstConfig> ast_style;
  if (with_style_ast) ast_style = AddAst(b, style);
  return fb::CreateZsMstm1Config(b, frames, d_text, d_pose, d_model, ast_content, ast_style,
                                 ast_shared, attention_heads, lstm_layers, lstm_hidden,
                                 decoder_layers, decoder_heads, decoder_ff, decoder_ln_eps,
                                 granularity, context_segments, style_pool, decoder_mode, positions,
                                 pose_source, frame_rate)
      .Union();
}

FileSpec TinyZsMstm::File() const {
  FileSpec file;
  file.networks[0].type = fb::Config::ZsMstm1Config;
  file.networks[0].config = [c = *this](flatbuffers::FlatBufferBuilder& b) { return c.Config(b); };
  const std::uint32_t content_width = content.d_out + d_text;
  const std::uint32_t style_attention = style.d_out + d_text;
  const std::uint32_t pose_row = granularity == fb::Granularity::Frame ? d_pose : frames * d_pose;
  Maker make(&file);
  make.Ast("ast_content.", content);
  if (!ast_shared) make.Ast("ast_style.", style);
  make.Multihead("content_attention", content_width);
  make.Multihead("style_attention", style_attention);
  for (std::uint32_t l = 0; l < lstm_layers; ++l) {
    const std::string at = "_l" + std::to_string(l);
    make.Add("pose_lstm.weight_ih" + at, {4 * lstm_hidden, l == 0 ? d_pose : lstm_hidden});
    make.Add("pose_lstm.weight_hh" + at, {4 * lstm_hidden, lstm_hidden});
    make.Add("pose_lstm.bias_ih" + at, {4 * lstm_hidden});
    make.Add("pose_lstm.bias_hh" + at, {4 * lstm_hidden});
  }
  make.Linear("dense", d_model, content_width + style_attention + lstm_hidden);
  if (decoder_mode == fb::DecoderMode::Autoregressive)
    make.Linear("pose_embedding", d_model, pose_row);
  for (std::uint32_t l = 0; l < decoder_layers; ++l) {
    const std::string at = "decoder.layers." + std::to_string(l) + ".";
    make.Multihead(at + "self_attn", d_model);
    make.Multihead(at + "multihead_attn", d_model);
    make.Linear(at + "linear1", decoder_ff, d_model);
    make.Linear(at + "linear2", d_model, decoder_ff);
    for (const char* norm : {"norm1", "norm2", "norm3"}) make.Norm(at + norm, d_model);
  }
  make.Linear("head", pose_row, d_model);
  return file;
}

std::shared_ptr<const WeightsFile> OpenOrFail(const FileSpec& spec) {
  const Bytes bytes = spec.Build();
  auto file = WeightsFile::FromMemory(bytes.data(), bytes.size(), "tiny");
  EXPECT_TRUE(file.ok()) << file.status().message();
  return file.ok() ? *file : nullptr;
}

std::unique_ptr<models::Network> MakeOrFail(const FileSpec& spec) {
  auto network = models::MakeNetwork(OpenOrFail(spec), "");
  EXPECT_TRUE(network.ok()) << network.status().message();
  return network.ok() ? *std::move(network) : nullptr;
}

models::Arrays TinyInputs(std::int64_t frames, std::int64_t clip_frames, std::uint32_t seed) {
  models::Arrays inputs;
  const auto add = [&](const char* name, std::int64_t rows, std::int64_t cols) {
    if (rows == 0) return;
    models::Array a = models::MakeArray({rows, cols});
    a.f32 = Noise(rows * cols, ++seed);
    inputs[name] = std::move(a);
  };
  add("speech", frames, 8);
  add("text", frames, 4);
  add("style_speech", clip_frames, 8);
  add("style_text", clip_frames, 4);
  add("style_pose", clip_frames, 6);
  return inputs;
}

}  // namespace gestus::test
