// One function for each kind of case: read the configuration, bind the tensors, declare the graph.
#include "bench/peers/networks.h"

#include <vector>

#include "engine/binder.h"
#include "models/ast/ast.h"
#include "models/bert/bert.h"
#include "models/blocks/seq2seq.h"
#include "models/blocks/weights.h"
#include "models/zs_mstm/networks.h"
#include "weights_generated.h"

namespace gestus::bench {

using namespace models;  // NOLINT: this file is a list of models

namespace {

Result<Graph> AstCase(const fb::Network& record, Binder& binder) {
  const Result<AstConfig> c = ReadAstConfig(*record.config_as_AstConfig(), "ast");
  if (!c.ok()) return c.status();
  AstWeights w;
  BindAst(binder, *c, &w);
  Graph g;
  g.Output("embedding", Ast(g, *c, w, g.Input("speech", {c->frames, c->mel_bins})));
  return g;
}

Result<Graph> BertCase(const fb::Network& record, Binder& binder, const InputSize& size) {
  const Result<BertConfig> c = ReadBertConfig(*record.config_as_BertConfig(), "bert");
  if (!c.ok()) return c.status();
  BertWeights w;
  BindBert(binder, *c, &w);
  Graph g;
  g.Output("hidden", Bert(g, *c, w, g.Input("ids", {size("ids")}, DType::kI32)));
  return g;
}

Result<Graph> LstmCase(const fb::Network& record, Binder& binder, const InputSize& size) {
  const fb::ClassifierConfig& c = *record.config_as_ClassifierConfig();
  std::vector<LstmWeights> layers;
  BindLstmStack(binder, "lstm", c.layers(), c.d_in(), c.hidden(), &layers);
  Graph g;
  Value x = g.Input("x", {size("x") / c.d_in(), c.d_in()});
  for (const LstmWeights& layer : layers) x = g.Lstm(x, layer);
  g.Output("rows", x);
  return g;
}

Result<Graph> BiLstmCase(const fb::Network& record, Binder& binder, const InputSize& size) {
  const fb::Model1Config& c = *record.config_as_Model1Config();
  EncoderWeights w;
  BindEncoder(binder, "e_text", c.d_text(), c.hidden1(), c.hidden2(), &w);
  Graph g;
  const Value text = g.Input("text", {size("text") / c.d_text(), c.d_text()});
  g.Output("h_text", Encode(g, w, c.alpha(), AeCode::kVector, text));
  return g;
}

Result<Graph> GeneratorCase(const fb::Network& record, Binder& binder) {
  const Result<ZsMstmConfig> c = ReadZsMstmConfig(record);
  if (!c.ok()) return c.status();
  GeneratorWeights w;
  BindLinear(binder, "dense", c->d_model, c->ContentWidth() + c->StyleWidth(), &w.dense);
  w.decoder.resize(static_cast<std::size_t>(c->decoder_layers));
  for (std::size_t i = 0; i < w.decoder.size(); ++i)
    BindDecoderLayer(binder, "decoder.layers." + std::to_string(i), c->d_model, c->decoder_ff,
                     c->decoder_ln_eps, &w.decoder[i]);
  BindLinear(binder, "head", c->Row(c->d_pose), c->d_model, &w.head);
  Graph g;
  const Value content = g.Input("content", {c->Rows(), c->ContentWidth()});
  const Value style = g.Input("style", {1, c->StyleWidth()});
  g.Output("pose", Generator(g, *c, w, c->d_pose, content, style));
  return g;
}

Result<Graph> Model2Case(const fb::Network& record, Binder& binder, const InputSize& size) {
  const Result<Model2Config> c = ReadModel2Config(*record.config_as_Model2Config(), "model2");
  if (!c.ok()) return c.status();
  Model2Weights w;
  BindModel2(binder, *c, &w);
  if (!binder.status().ok()) return binder.status();
  return Model2Pass(*c, w, size);
}

Result<Graph> Declare(const fb::Network& record, Binder& binder, const InputSize& size) {
  switch (record.config_type()) {
    case fb::Config::AstConfig:
      return AstCase(record, binder);
    case fb::Config::BertConfig:
      return BertCase(record, binder, size);
    case fb::Config::ClassifierConfig:
      return LstmCase(record, binder, size);
    case fb::Config::Model1Config:
      return BiLstmCase(record, binder, size);
    case fb::Config::ZsMstm1Config:
      return GeneratorCase(record, binder);
    case fb::Config::Model2Config:
      return Model2Case(record, binder, size);
    default:
      return Status(Code::kBadWeights, "a kind of network that is no case of this benchmark");
  }
}

}  // namespace

Result<Graph> DeclareNetwork(const WeightsFile& file, const InputSize& size) {
  const fb::Network* record = file.FindNetwork("");
  if (record == nullptr)
    return Status(Code::kBadWeights, file.path() + ": several networks, expected one");
  Binder binder(file, record->prefix()->str());
  Result<Graph> graph = Declare(*record, binder, size);
  if (!binder.status().ok()) return binder.status().In(file.path());
  if (graph.ok() && !graph->status().ok()) return graph->status().In(file.path());
  return graph;
}

}  // namespace gestus::bench
