// E_content (thesis 6.5.1): what is said, by voice and by words.
#include "models/zs_mstm/networks.h"

namespace gestus::models {

Value ContentEncoder(Graph& g, const ZsMstmConfig& c, const ZsMstmWeights& w, Value speech,
                     Value text) {
  const Graph::Scope scope(g, "content");
  std::vector<Value> rows;
  for (std::int64_t s = 0; s < c.context_segments; ++s) {
    const Value e_speech =
        Ast(g, c.ast_content, w.ast_content, g.Rows(speech, s * c.frames, c.frames));
    const Value x_text = g.Rows(text, s * c.frames, c.frames);  // (T, d_text)
    rows.push_back(c.granularity == Granularity::kFrame
                       ? g.Concat({g.RepeatRows(e_speech, c.frames), x_text})
                       : g.Concat({e_speech, g.MeanRows(x_text)}));
  }
  // eq. 6.1: h_content = sa([E_speech, X_text])
  const Value h_content =
      SelfAttention(g, w.content_attention, c.attention_heads,
                    rows.size() == 1 ? rows[0] : g.ConcatRows(rows));  // (rows, d_att)
  g.Tap("attention", h_content);
  return h_content;
}

}  // namespace gestus::models
