// ZS-MSTM 1.0 (thesis chapter 6) and 2.0 (chapter 7), which adds a face and dialog acts: their
// letters, their weights.
#ifndef GESTUS_MODELS_ZS_MSTM_CONFIG_H_
#define GESTUS_MODELS_ZS_MSTM_CONFIG_H_

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
}  // namespace gestus::fb

namespace gestus::models {

enum class Granularity { kFrame, kSegment };
enum class DecoderMode { kAutoregressive, kShiftedParallel, kParallel };
enum class PositionalEncoding { kNone, kSinusoidal };

struct ZsMstmConfig {
  std::int64_t frames = 64;   ///< of one segment
  std::int64_t d_text = 768;  ///< X_text
  std::int64_t d_pose = 22;
  std::int64_t d_face = 0, d_tags = 0;  ///< 2.0; 1.0 has none
  bool dense_shared = false;            ///< 2.0: one Dense before both decoders
  std::int64_t d_model = 768;           ///< width of the decoder
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
  Normalisation speech, text, pose, face;

  bool HasFace() const { return d_face > 0; }

  /// Frames that one run of the generator takes.
  std::int64_t WindowFrames() const { return frames * context_segments; }
  /// Rows of the generator's sequences, and the width of one that holds `width` values a frame.
  std::int64_t Rows() const {
    return granularity == Granularity::kFrame ? frames : context_segments;
  }
  std::int64_t Row(std::int64_t width) const {
    return granularity == Granularity::kFrame ? width : frames * width;
  }
  std::int64_t ContentWidth() const { return ast_content.d_out + d_text; }
  std::int64_t StyleAttentionWidth() const { return d_text + ast_style.d_out; }
  /// h_style, eq. 6.2 and 7.1.
  std::int64_t StyleWidth() const {
    return StyleAttentionWidth() + lstm_hidden + (HasFace() ? lstm_hidden : 0) + d_tags;
  }
};

/// One decoder of G, for poses or for faces.
struct GeneratorWeights {
  LinearWeights dense;      // (d_model, content + style)
  LinearWeights embedding;  // (d_model, row); autoregressive mode only
  std::vector<DecoderLayerWeights> decoder;
  LinearWeights head;  // (row, d_model)
};

struct ZsMstmWeights {
  AstWeights ast_content, ast_style;
  MultiheadWeights content_attention, style_attention;
  std::vector<LstmWeights> pose_lstm, face_lstm;  // E_pose, E_face
  GeneratorWeights pose, face;
};

/// 1.0 or 2.0, as the network's record says.
Result<ZsMstmConfig> ReadZsMstmConfig(const fb::Network& network);
void BindZsMstm(Binder& binder, const ZsMstmConfig& c, ZsMstmWeights* w);
/// Both for `network` of `file`, of which nothing may be left over; errors begin with the path.
Status LoadZsMstm(const WeightsFile& file, const fb::Network& network, ZsMstmConfig* c,
                  ZsMstmWeights* w);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_ZS_MSTM_CONFIG_H_
