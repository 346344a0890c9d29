// Model 1 as a graph, one word at a time.
#include "models/model1/model1.h"

namespace gestus::models {

Value Model1Encoder(Graph& g, const Model1Config& c, const Model1Weights& w, Value f0, Value text) {
  Value x = Encode(g, w.e1_speech, c.ae_alpha, c.code, f0);  // E1_speech
  g.Tap("e1_speech", x);
  if (c.code == AeCode::kVector) x = g.RepeatRows(x, c.f0_length);
  const Value h_speech = Encode(g, w.e2_speech, c.alpha, AeCode::kVector, x);  // (1, 2 hidden2)
  g.Tap("h_speech", h_speech);
  const Value h_text = Encode(g, w.e_text, c.alpha, AeCode::kVector, text);
  g.Tap("h_text", h_text);
  return g.Concat({h_speech, h_text});
}

Value Model1Decoder(Graph& g, const Model1Config& c, const Model1Weights& w, std::size_t n,
                    Value h) {
  const std::string channel = std::to_string(n);
  const Value z = Decode(g, w.faces[n].decoder, c.ae_alpha, c.out_length, h);
  g.Tap("d_face." + channel, z);
  const Value probabilities = g.Softmax(g.Linear(z, w.faces[n].head));
  g.Tap("probabilities." + channel, probabilities);
  return probabilities;
}

}  // namespace gestus::models
