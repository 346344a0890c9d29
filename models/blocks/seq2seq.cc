// Bidirectional encoder, repeating decoder.
#include "models/blocks/seq2seq.h"

namespace gestus::models {
namespace {

Value LeakyRelu(Graph& g, Value x, float alpha) {
  return g.Activate(x, Activation::kLeakyRelu, alpha);
}

}  // namespace

void BindEncoder(Binder& binder, const std::string& name, std::int64_t in, std::int64_t h1,
                 std::int64_t h2, EncoderWeights* w) {
  const Binder::Scope scope(binder, name + ".");
  BindBiLstm(binder, "lstm1", in, h1, &w->lstm1);
  BindBiLstm(binder, "lstm2", 2 * h1, h2, &w->lstm2);
}

void BindDecoder(Binder& binder, const std::string& name, std::int64_t in, std::int64_t h1,
                 std::int64_t h2, DecoderWeights* w) {
  const Binder::Scope scope(binder, name + ".");
  BindLstm(binder, "lstm1", in, h1, &w->lstm1);
  BindLstm(binder, "lstm2", h1, h2, &w->lstm2);
}

Value Encode(Graph& g, const EncoderWeights& w, float alpha, AeCode code, Value x) {
  x = g.Concat({g.Lstm(x, w.lstm1.forward), g.Lstm(x, w.lstm1.backward, true)});  // (T, 2 h1)
  x = LeakyRelu(g, x, alpha);
  g.Tap("lstm1", x);
  Value forward = g.Lstm(x, w.lstm2.forward), backward = g.Lstm(x, w.lstm2.backward, true);
  if (code == AeCode::kVector) {
    forward = g.Rows(forward, g.shape(x).Rows() - 1, 1);
    backward = g.Rows(backward, 0, 1);
  }
  return LeakyRelu(g, g.Concat({forward, backward}), alpha);
}

Value Decode(Graph& g, const DecoderWeights& w, float alpha, std::int64_t length, Value h) {
  if (g.shape(h).Rows() == 1) h = g.RepeatRows(h, length);
  h = LeakyRelu(g, g.Lstm(h, w.lstm1), alpha);  // (length, h1)
  g.Tap("lstm1", h);
  h = LeakyRelu(g, g.Lstm(h, w.lstm2), alpha);  // (length, h2)
  g.Tap("lstm2", h);
  return h;
}

}  // namespace gestus::models
