// E_style (thesis 6.5.2, 7.3.2): how a speaker moves, looks, talks and words it.
#include "models/zs_mstm/networks.h"

namespace gestus::models {
namespace {

/// E_pose, E_face: "the last hidden layer" of stacked LSTMs over x (T, d) -> (1, H).
Value LastHidden(Graph& g, const std::string& name, const std::vector<LstmWeights>& layers,
                 Value x) {
  for (std::size_t l = 0; l < layers.size(); ++l) {
    x = g.Lstm(x, layers[l]);  // (T, H)
    g.Tap(name + "." + std::to_string(l), x);
  }
  return g.Rows(x, g.shape(x).Rows() - 1, 1);
}

}  // namespace

Value StyleEncoder(Graph& g, const ZsMstmConfig& c, const ZsMstmWeights& w, const StyleInputs& x) {
  const Graph::Scope scope(g, "style");
  const Value e_speech = Ast(g, c.ast_style, w.ast_style, x.speech);  // (1, d_speech)
  const Value s = c.granularity == Granularity::kFrame
                      ? g.Concat({x.text, g.RepeatRows(e_speech, c.frames)})
                      : g.Concat({g.MeanRows(x.text), e_speech});
  const Value sa = SelfAttention(g, w.style_attention, c.attention_heads, s);  // (T, d_att)
  g.Tap("attention", sa);

  // eq. 6.2: h_style = [sa([X_text, E_speech]), E_pose]
  std::vector<Value> h_style = {Pool(g, c.style_pool, sa),
                                LastHidden(g, "pose_lstm", w.pose_lstm, x.pose)};
  if (c.HasFace()) {  // eq. 7.1: [.., E_face, X_tags]
    h_style.push_back(LastHidden(g, "face_lstm", w.face_lstm, x.face));
    h_style.push_back(x.tags);
  }
  const Value h = g.Concat(h_style);
  g.Tap("h_style", h);
  return h;
}

Graph StyleGraph(const ZsMstmConfig& c, const ZsMstmWeights& w) {
  Graph g;
  StyleInputs x;
  x.speech = c.speech.Apply(g, g.Input("speech", {c.frames, c.ast_style.mel_bins}));
  x.text = c.text.Apply(g, g.Input("text", {c.frames, c.d_text}));
  x.pose = c.pose.Apply(g, g.Input("pose", {c.frames, c.d_pose}));
  if (c.HasFace()) {
    x.face = c.face.Apply(g, g.Input("face", {c.frames, c.d_face}));
    x.tags = g.Input("tags", {1, c.d_tags});
  }
  g.Output("style", StyleEncoder(g, c, w, x));
  return g;
}

}  // namespace gestus::models
