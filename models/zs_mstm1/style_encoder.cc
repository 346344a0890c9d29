// E_style (thesis 6.5.2): how a speaker moves, talks and words it.
#include "models/zs_mstm1/networks.h"

namespace gestus::models {

Value StyleEncoder(Graph& g, const ZsMstm1Config& c, const ZsMstm1Weights& w, Value speech,
                   Value text, Value pose) {
  const Graph::Scope scope(g, "style");
  const Value e_speech = Ast(g, c.ast_style, w.ast_style, speech);  // (1, d_speech)
  const Value s = c.granularity == Granularity::kFrame
                      ? g.Concat({text, g.RepeatRows(e_speech, c.frames)})
                      : g.Concat({g.MeanRows(text), e_speech});
  const Value sa = SelfAttention(g, w.style_attention, c.attention_heads, s);  // (T, d_att)
  g.Tap("attention", sa);

  Value h = pose;  // (T, d_pose)
  for (std::size_t l = 0; l < w.pose_lstm.size(); ++l) {
    h = g.Lstm(h, w.pose_lstm[l]);  // (T, H)
    g.Tap("pose_lstm." + std::to_string(l), h);
  }
  const Value e_pose = g.Rows(h, c.frames - 1, 1);  // last hidden

  // eq. 6.2: h_style = [sa([X_text, E_speech]), E_pose]
  const Value h_style = g.Concat({Pool(g, c.style_pool, sa), e_pose});
  g.Tap("h_style", h_style);
  return h_style;
}

Graph StyleGraph(const ZsMstm1Config& c, const ZsMstm1Weights& w) {
  Graph g;
  const Value speech = g.Input("speech", {c.frames, c.ast_style.mel_bins});
  const Value text = g.Input("text", {c.frames, c.d_text});
  const Value pose = g.Input("pose", {c.frames, c.d_pose});
  g.Output("style", StyleEncoder(g, c, w, c.speech.Apply(g, speech), c.text.Apply(g, text),
                                 c.pose.Apply(g, pose)));
  return g;
}

}  // namespace gestus::models
