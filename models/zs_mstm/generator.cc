// G (thesis 6.5.3, 7.3.3): Transformer decoders that turn content and style into poses and faces.
#include "models/zs_mstm/networks.h"

namespace gestus::models {
namespace {

/// tgt_j = embed(out_{j-1}) one row after the other, keys and values of past rows kept.
Value Autoregressive(Graph& g, const ZsMstmConfig& c, const GeneratorWeights& w, Value z) {
  const std::int64_t rows = c.Rows();
  const bool positions = c.positions == PositionalEncoding::kSinusoidal;
  const Value pe = positions ? g.Positions(rows, c.d_model) : Value{};
  const Value out = g.Buffer({rows, w.head.weight.shape[0]});
  std::vector<Value> memory, cache, trace;
  for (const DecoderLayerWeights& layer : w.decoder) {
    memory.push_back(MemoryKeysValues(g, layer, z));
    cache.push_back(g.Buffer({rows, 2 * c.d_model}));
    trace.push_back(g.Buffer({rows, c.d_model}));
  }
  g.BeginLoop(rows);
  Value x = g.Linear(g.PreviousRow(out), w.embedding);  // (1, d_model)
  if (positions) x = g.Add(x, g.StepRow(pe));
  for (std::size_t i = 0; i < w.decoder.size(); ++i) {
    x = DecoderLayerStep(g, w.decoder[i], c.decoder_heads, x, memory[i], cache[i]);
    g.StoreRows(trace[i], x);
  }
  g.StoreRows(out, g.Linear(x, w.head));
  g.EndLoop();
  for (std::size_t i = 0; i < trace.size(); ++i) g.Tap("decoder." + std::to_string(i), trace[i]);
  return out;  // (rows, row)
}

/// All rows at once; `tgt` is z, or z one row later.
Value Parallel(Graph& g, const ZsMstmConfig& c, const GeneratorWeights& w, Value z) {
  const std::int64_t rows = c.Rows();
  Value x = z;
  if (c.decoder_mode == DecoderMode::kShiftedParallel) {
    const Value start = g.Zeros({1, c.d_model});
    x = rows == 1 ? start : g.ConcatRows({start, g.Rows(z, 0, rows - 1)});
  }
  if (c.positions == PositionalEncoding::kSinusoidal) x = g.Add(x, g.Positions(rows, c.d_model));
  for (std::size_t i = 0; i < w.decoder.size(); ++i) {
    x = DecoderLayer(g, w.decoder[i], c.decoder_heads, x, MemoryKeysValues(g, w.decoder[i], z));
    g.Tap("decoder." + std::to_string(i), x);
  }
  return g.Linear(x, w.head);  // (rows, row)
}

}  // namespace

Value Generator(Graph& g, const ZsMstmConfig& c, const GeneratorWeights& w, std::int64_t columns,
                Value h_content, Value h_style) {
  const Value z =
      g.Linear(g.Concat({h_content, g.RepeatRows(h_style, c.Rows())}), w.dense);  // (rows, d_model)
  g.Tap("z", z);
  Value out = c.decoder_mode == DecoderMode::kAutoregressive ? Autoregressive(g, c, w, z)
                                                             : Parallel(g, c, w, z);
  out = g.Reshape(out, {c.WindowFrames(), columns});
  g.Tap("head", out);
  return out;
}

Graph GeneratorGraph(const ZsMstmConfig& c, const ZsMstmWeights& w) {
  Graph g;
  const std::int64_t frames = c.WindowFrames();
  const Value speech = g.Input("speech", {frames, c.ast_content.mel_bins});
  const Value text = g.Input("text", {frames, c.d_text});
  const Value style = g.Input("style", {1, c.StyleWidth()});
  const Value content = ContentEncoder(g, c, w, c.speech.Apply(g, speech), c.text.Apply(g, text));
  {
    const Graph::Scope scope(g, c.HasFace() ? "pose_generator" : "generator");
    g.Output("pose", c.pose.Undo(g, Generator(g, c, w.pose, c.d_pose, content, style)));
  }
  if (c.HasFace()) {
    const Graph::Scope scope(g, "face_generator");
    g.Output("face", c.face.Undo(g, Generator(g, c, w.face, c.d_face, content, style)));
  }
  return g;
}

}  // namespace gestus::models
