// BERT as a graph.  T tokens, D = d_model.
#include "models/bert/bert.h"

#include "models/blocks/weights.h"

namespace gestus::models {
namespace {

/// Post-norm encoder layer (Vaswani et al. 2017, figure 1) with GELU.
Value EncoderLayer(Graph& g, const BertConfig& c, const BertWeights::Layer& w, Value x) {
  const Value att = MultiHead(g, w.attention, {.heads = static_cast<int>(c.heads)}, x, x);
  x = g.LayerNorm(g.Add(x, att), w.attention_norm);
  const Value hidden = g.Linear(x, w.intermediate, Activation::kGeluErf);  // (T, d_mlp)
  return g.LayerNorm(g.Add(x, g.Linear(hidden, w.output)), w.output_norm);
}

/// Rows [0, count) of a table.
TensorView FirstRows(TensorView table, std::int64_t count) {
  table.shape = {count, table.shape.Cols()};
  return table;
}

}  // namespace

Value Bert(Graph& g, const BertConfig& c, const BertWeights& w, Value ids) {
  const std::int64_t length = g.shape(ids).NumElements();
  Value x = g.Add(g.Embedding(ids, w.words), g.Constant(FirstRows(w.positions, length)));
  // One sentence: every token is of the first type.
  if (c.types > 0) x = g.Add(x, g.Constant(FirstRows(w.types, 1)));
  x = g.LayerNorm(x, w.norm);  // (T, D)
  {
    const Graph::Scope scope(g, "embeddings");
    g.Tap("out", x);
  }
  for (std::size_t i = 0; i < w.layers.size(); ++i) {
    const Graph::Scope scope(g, "layer." + std::to_string(i));
    x = EncoderLayer(g, c, w.layers[i], x);
    g.Tap("out", x);
  }
  return x;
}

Value BertClassifier(Graph& g, const BertWeights& w, Value hidden) {
  const Graph::Scope scope(g, "classifier");
  const Value x = g.Linear(g.Rows(hidden, 0, 1), w.pre_classifier, Activation::kRelu);
  return g.Softmax(g.Linear(x, w.classifier));
}

void BindBert(Binder& binder, const BertConfig& c, BertWeights* w) {
  const std::int64_t d = c.d_model;
  binder.Bind({{"embeddings.word_embeddings.weight", &w->words, {c.tokens, d}, Binder::kProduct},
               {"embeddings.position_embeddings.weight", &w->positions, {c.positions, d}}});
  if (c.types > 0)
    binder.Bind({{"embeddings.token_type_embeddings.weight", &w->types, {c.types, d}}});
  BindNorm(binder, "embeddings.LayerNorm", d, c.ln_eps, &w->norm);
  w->layers.resize(static_cast<std::size_t>(c.layers));
  for (std::size_t i = 0; i < w->layers.size(); ++i) {
    BertWeights::Layer& layer = w->layers[i];
    const Binder::Scope scope(binder, "encoder.layer." + std::to_string(i) + ".");
    BindLinear(binder, "attention.self.query", d, d, &layer.attention.query);
    BindLinear(binder, "attention.self.key", d, d, &layer.attention.key);
    BindLinear(binder, "attention.self.value", d, d, &layer.attention.value);
    BindLinear(binder, "attention.output.dense", d, d, &layer.attention.out);
    BindNorm(binder, "attention.output.LayerNorm", d, c.ln_eps, &layer.attention_norm);
    BindLinear(binder, "intermediate.dense", c.d_mlp, d, &layer.intermediate);
    BindLinear(binder, "output.dense", d, c.d_mlp, &layer.output);
    BindNorm(binder, "output.LayerNorm", d, c.ln_eps, &layer.output_norm);
  }
  if (c.head == BertHead::kClassifier) {
    BindLinear(binder, "pre_classifier", d, d, &w->pre_classifier);
    BindLinear(binder, "classifier", static_cast<std::int64_t>(c.labels.size()), d, &w->classifier);
  }
}

}  // namespace gestus::models
