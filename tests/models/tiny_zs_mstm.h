// A ZS-MSTM 1.0 of a few thousand weights, made in memory, every field of its configuration open.
#ifndef GESTUS_TESTS_MODELS_TINY_ZS_MSTM_H_
#define GESTUS_TESTS_MODELS_TINY_ZS_MSTM_H_

#include <cstdint>
#include <memory>
#include <string>

#include "engine/weights_file.h"
#include "models/network.h"
#include "tests/engine/weights_builder.h"

namespace gestus::test {

struct TinyAst {
  std::uint32_t frames = 8, mel_bins = 8, patch = 4, stride = 4;
  std::uint32_t d_model = 8, layers = 2, heads = 2, d_mlp = 12;
  fb::AstPool pool = fb::AstPool::Cls;
  fb::AstHead head = fb::AstHead::None;
  std::uint32_t d_out = 8;
  float ln_eps = 1e-6f, head_ln_eps = 1e-5f;
};

struct TinyZsMstm {
  std::uint32_t frames = 8, d_text = 4, d_pose = 6, d_model = 8;
  TinyAst content{}, style{};
  bool with_style_ast = true, ast_shared = false;
  std::uint32_t attention_heads = 2, lstm_layers = 2, lstm_hidden = 5;
  std::uint32_t decoder_layers = 2, decoder_heads = 2, decoder_ff = 10;
  float decoder_ln_eps = 1e-5f;
  fb::Granularity granularity = fb::Granularity::Frame;
  std::uint32_t context_segments = 1;
  fb::StylePool style_pool = fb::StylePool::Mean;
  fb::DecoderMode decoder_mode = fb::DecoderMode::Autoregressive;
  fb::PositionalEncoding positions = fb::PositionalEncoding::Sinusoidal;
  fb::PoseSource pose_source = fb::PoseSource::Normalize;
  float frame_rate = 15.0f;

  flatbuffers::Offset<void> Config(flatbuffers::FlatBufferBuilder& b) const;
  /// The file with all tensors that the configuration asks for, of noise, and no statistics.
  FileSpec File() const;
};

std::shared_ptr<const WeightsFile> OpenOrFail(const FileSpec& spec);
std::unique_ptr<models::Network> MakeOrFail(const FileSpec& spec);

/// Speech, text and a style clip of as many frames, from a seed.
models::Arrays TinyInputs(std::int64_t frames, std::int64_t clip_frames, std::uint32_t seed);

}  // namespace gestus::test

#endif  // GESTUS_TESTS_MODELS_TINY_ZS_MSTM_H_
