// Model 1 (thesis 5.5.3, 5.5.4): f0 and the meaning of a word to action units and head angles, by
// LSTMs.
#ifndef GESTUS_MODELS_MODEL1_MODEL1_H_
#define GESTUS_MODELS_MODEL1_MODEL1_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "models/blocks/seq2seq.h"
#include "models/channels.h"
#include "models/network.h"
#include "models/normalisation.h"

namespace gestus::models {

struct Model1Config {
  std::int64_t f0_length = 100;  ///< f0 values of a word
  std::int64_t d_text = 768, text_rows = 1;
  std::int64_t ae_hidden = 100;  ///< N_hid of E_speech and D_face
  float ae_alpha = 0.05f;
  AeCode code = AeCode::kVector;              ///< what E1_speech hands to E2_speech
  std::int64_t hidden1 = 200, hidden2 = 100;  ///< of E2_speech and E_text
  float alpha = 0.01f;
  std::int64_t out_length = 124;
  std::vector<Channel> channels;
  Normalisation f0, text;
};

struct Model1Weights {
  EncoderWeights e1_speech, e2_speech, e_text;
  struct Face {
    DecoderWeights decoder;
    LinearWeights head;  // (tokens, 2 ae_hidden)
  };
  std::vector<Face> faces;  // one a channel
};

/// h_speech,text, eq. 5.4: f0 (f0_length, 1), text (text_rows, d_text) -> (1, 4 hidden2).
Value Model1Encoder(Graph& g, const Model1Config& c, const Model1Weights& w, Value f0, Value text);
/// D_face of channel `n` and its Dense, eq. 5.5 and 5.6: probabilities (out_length, tokens).
Value Model1Decoder(Graph& g, const Model1Config& c, const Model1Weights& w, std::size_t n,
                    Value h);

/// Inputs `f0` (words, f0_length), `text`; outputs `face`, `tokens`, `lengths`.
Result<std::unique_ptr<Network>> MakeModel1Network(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const NetworkOptions& options);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_MODEL1_MODEL1_H_
