// ZS-MSTM 1.0 (thesis chapter 6): its letters, its weights.
#ifndef GESTUS_MODELS_ZS_MSTM1_CONFIG_H_
#define GESTUS_MODELS_ZS_MSTM1_CONFIG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/binder.h"
#include "engine/graph.h"
#include "models/ast/ast.h"
#include "models/blocks/pool.h"
#include "models/blocks/transformer.h"
#include "models/normalisation.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::models {

enum class Granularity { kFrame, kSegment };
enum class DecoderMode { kAutoregressive, kShiftedParallel, kParallel };
enum class PositionalEncoding { kNone, kSinusoidal };

struct ZsMstm1Config {
  std::int64_t frames = 64;   ///< of one segment
  std::int64_t d_text = 768;  ///< X_text
  std::int64_t d_pose = 22;
  std::int64_t d_model = 768;  ///< width of the decoder
  AstConfig ast_content, ast_style;
  bool ast_shared = false;
  int attention_heads = 4;
  std::int64_t lstm_layers = 3, lstm_hidden = 768;
  std::int64_t decoder_layers = 1, decoder_ff = 2048;
  int decoder_heads = 2;
  float decoder_ln_eps = 1e-5f;
  Granularity granularity = Granularity::kFrame;
  std::int64_t context_segments = 1;
  StylePool style_pool = StylePool::kMean;
  DecoderMode decoder_mode = DecoderMode::kAutoregressive;
  PositionalEncoding positions = PositionalEncoding::kSinusoidal;
  double frame_rate = 15.0;
  Normalisation speech, text, pose;

  /// Frames that one run of the generator takes.
  std::int64_t WindowFrames() const { return frames * context_segments; }
  /// Rows of the generator's sequences, and the width of a row of poses.
  std::int64_t Rows() const {
    return granularity == Granularity::kFrame ? frames : context_segments;
  }
  std::int64_t PoseRow() const {
    return granularity == Granularity::kFrame ? d_pose : frames * d_pose;
  }
  std::int64_t ContentWidth() const { return ast_content.d_out + d_text; }
  std::int64_t StyleAttentionWidth() const { return d_text + ast_style.d_out; }
  std::int64_t StyleWidth() const { return StyleAttentionWidth() + lstm_hidden; }
};

struct ZsMstm1Weights {
  AstWeights ast_content, ast_style;
  MultiheadWeights content_attention, style_attention;
  std::vector<LstmWeights> pose_lstm;  // E_pose
  LinearWeights dense;                 // (d_model, content + style)
  LinearWeights pose_embedding;        // (d_model, pose row); autoregressive mode only
  std::vector<DecoderLayerWeights> decoder;
  LinearWeights head;  // (pose row, d_model)
};

Result<ZsMstm1Config> ReadZsMstm1Config(const fb::Network& network);
void BindZsMstm1(Binder& binder, const ZsMstm1Config& c, ZsMstm1Weights* w);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM1_CONFIG_H_
