// Audio Spectrogram Transformer (Gong, Chung, Glass 2021), E_speech of the thesis (6.5.1): a
// log-mel spectrogram cut into overlapping patches, two tokens in front, pre-norm encoder blocks.
#ifndef GESTUS_MODELS_AST_AST_H_
#define GESTUS_MODELS_AST_AST_H_

#include <cstdint>
#include <vector>

#include "engine/binder.h"
#include "engine/graph.h"

namespace gestus::fb {
struct AstConfig;
}

namespace gestus::models {

enum class AstPool { kCls, kMeanClsDist };
enum class AstHead { kNone, kLayerNormLinear, kLinear };

struct AstConfig {
  std::int64_t frames = 64;     ///< T
  std::int64_t mel_bins = 128;  ///< F
  std::int64_t patch = 16, stride = 10;
  std::int64_t d_model = 768;  ///< D
  std::int64_t layers = 12, heads = 12;
  std::int64_t d_mlp = 3072;
  AstPool pool = AstPool::kCls;
  AstHead head = AstHead::kNone;
  std::int64_t d_out = 768;
  float ln_eps = 1e-6f, head_ln_eps = 1e-5f;

  std::int64_t Patches() const {
    return ((frames - patch) / stride + 1) * ((mel_bins - patch) / stride + 1);
  }
};

struct AstWeights {
  struct Block {
    NormWeights norm1, norm2;
    LinearWeights qkv, proj;  // (3D, D), (D, D)
    LinearWeights fc1, fc2;   // (d_mlp, D), (D, d_mlp)
  };
  TensorView cls, dist;  // (1, D)
  TensorView positions;  // (2 + patches, D)
  LinearWeights patch;   // (D, patch * patch)
  std::vector<Block> blocks;
  NormWeights norm, head_norm;
  LinearWeights head;  // (d_out, D)
};

/// Checks every field; `where` names the configuration in messages.
Result<AstConfig> ReadAstConfig(const fb::AstConfig& config, const std::string& where);
/// Binds the published key names, "v.cls_token" to "mlp_head.1.bias".
void BindAst(Binder& binder, const AstConfig& c, AstWeights* w);
/// x (T, F), normalised -> (1, d_out).
Value Ast(Graph& g, const AstConfig& c, const AstWeights& w, Value x);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_AST_AST_H_
