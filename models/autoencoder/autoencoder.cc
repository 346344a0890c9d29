// The autoencoder's two halves.
#include "models/autoencoder/autoencoder.h"

namespace gestus::models {

Value AutoencoderEncoder(Graph& g, const AutoencoderConfig& c, const AutoencoderWeights& w,
                         Value x) {
  const Graph::Scope scope(g, "encoder");
  const Value h = Encode(g, w.encoder, c.alpha, c.code, x);
  g.Tap("code", h);
  return h;
}

Value AutoencoderDecoder(Graph& g, const AutoencoderConfig& c, const AutoencoderWeights& w,
                         Value h) {
  const Graph::Scope scope(g, "decoder");
  return g.Linear(Decode(g, w.decoder, c.alpha, c.length, h), w.dense);  // (L, 1)
}

}  // namespace gestus::models
