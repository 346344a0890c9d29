// Model 2 (thesis 5.6): f0 and words of an inter-pausal unit to action units and head angles, by a
// Transformer whose cross-modality attention lets one modality pick from the other.
#ifndef GESTUS_MODELS_MODEL2_MODEL2_H_
#define GESTUS_MODELS_MODEL2_MODEL2_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/binder.h"
#include "engine/graph.h"
#include "models/blocks/attention.h"
#include "models/channels.h"
#include "models/network.h"
#include "models/normalisation.h"

namespace gestus::fb {
struct Model2Config;
}  // namespace gestus::fb

namespace gestus::models {

enum class Master { kText, kSpeech };

struct Model2Config {
  std::int64_t max_words = 10, f0_length = 100;  ///< of an inter-pausal unit, of a word
  float f0_minimum = 50.0f, f0_step = 1.0f;      ///< Hz
  std::int64_t f0_tokens = 500;
  std::int64_t d_text = 768, d_model = 64;
  std::int64_t convolutions = 3, kernel = 3;
  std::int64_t encoder_layers = 4, encoder_heads = 4, encoder_ff = 400;
  Master master = Master::kText;
  std::int64_t attention_heads = 4, attention_ff = 400;
  std::int64_t attention_width = 64;  ///< of H_att
  std::int64_t decoder_layers = 4, decoder_heads = 4, decoder_ff = 400;
  bool conv_decoder = true;
  bool shared_norm = false;
  bool scaled = false;  ///< scores by 1 / sqrt(width of a head)
  float ln_eps = 1e-6f;
  std::int64_t max_out = 124;
  std::vector<Channel> channels;
  Normalisation text;

  std::int64_t Stacks() const;
  /// The token of one f0 value; 0 for unvoiced.
  std::int32_t F0Token(float hz) const;
};

struct Model2Weights {
  /// Post-norm layer; encoder layers have no cross-attention and no norm3.
  struct Layer {
    AttentionWeights self_attn, cross_attn;
    NormWeights norm1, norm2, norm3;
    LinearWeights linear1, linear2;
  };
  struct Stack {
    TensorView embedding;  // (tokens, d_model)
    std::vector<Layer> layers;
  };
  TensorView f0_embedding;             // (f0_tokens, d_model)
  std::vector<LinearWeights> f0_conv;  // (d_model, d_model, kernel) each
  std::vector<Layer> encoder;
  LinearWeights text_projection;  // (d_model, d_text), master text
  Layer cross;
  LinearWeights cross_output;  // (d_text, d_model), H_att as wide as X_text
  std::vector<Stack> decoders;
  std::vector<LinearWeights> conv_decoder;
  std::vector<LinearWeights> heads;  // (tokens, d_model), one a channel
};

Result<Model2Config> ReadModel2Config(const fb::Model2Config& config, const std::string& where);
void BindModel2(Binder& binder, const Model2Config& c, Model2Weights* w);

/// E1_speech and E2_speech, eq. 5.8 and 5.9, each word by itself: f0 tokens (words * f0_length)
/// -> (words * f0_length, d_model).
Value F0Encoder(Graph& g, const Model2Config& c, const Model2Weights& w, Value f0);
/// A, eq. 5.10 to 5.12: speech (words * f0_length, d_model), text (words, d_text) -> H_att.
Value CrossModality(Graph& g, const Model2Config& c, const Model2Weights& w, Value speech,
                    Value text);
/// D2_face and D1_face, eq. 5.13 to 5.16: the tokens of every channel, (max_out, 1) each, all
/// sequences in lock-step.  `controls` (1, 2) and `u` (max_out, channels) as in Graph::Pick.
std::vector<Value> FaceDecoder(Graph& g, const Model2Config& c, const Model2Weights& w, Value h_att,
                               Value controls, Value u);

/// Inputs `f0` (words, f0_length), `text` (words, d_text); outputs `face`, `tokens`, `lengths`.
Result<std::unique_ptr<Network>> MakeModel2Network(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_MODEL2_MODEL2_H_
