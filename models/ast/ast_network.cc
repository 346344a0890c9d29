// Runs AST over the segments of a spectrogram.
#include "models/ast/ast_network.h"

#include "models/ast/ast.h"
#include "models/graph_network.h"
#include "models/normalisation.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

class AstNetwork final : public GraphNetwork {
 public:
  const char* kind() const override { return "AST"; }

 private:
  Status Load(const fb::Network& record, Binder& binder) override {
    const std::string where = "network " + record.name()->str();
    Result<AstConfig> config = ReadAstConfig(*record.config_as_AstConfig(), where);
    if (!config.ok()) return config.status();
    c_ = *std::move(config);
    Result<Normalisation> speech = ReadNormalisation(record, "speech", c_.mel_bins);
    if (!speech.ok()) return speech.status();
    speech_ = *std::move(speech);
    BindAst(binder, c_, &w_);
    return {};
  }

  Signature Describe() const override {
    return {{Spec("speech", {ArraySpec::kAny, c_.mel_bins}, {"frames", "mel bins"}, "ln power",
                  "log-mel spectrogram")},
            {Spec("embedding", {ArraySpec::kAny, c_.d_out}, {"segments", "features"}, "-",
                  "one vector for each segment of " + std::to_string(c_.frames) + " frames")}};
  }

  Graph Declare() const override {
    Graph g;
    const Value speech = g.Input("speech", {c_.frames, c_.mel_bins});
    g.Output("embedding", Ast(g, c_, w_, speech_.Apply(g, speech)));
    return g;
  }

  Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) override {
    const Array& speech = inputs.at("speech");
    RunWindows(speech, "speech", c_.frames, "embedding", items, outputs);
    if (items.report != nullptr) items.report->frames = static_cast<std::size_t>(speech.shape[0]);
    return {};
  }
  AstConfig c_;
  AstWeights w_;
  Normalisation speech_;
};

}  // namespace

Result<std::unique_ptr<Network>> MakeAstNetwork(std::shared_ptr<const WeightsFile> file,
                                                const std::string& name,
                                                const NetworkOptions& options) {
  return GraphNetwork::Make<AstNetwork>(std::move(file), name, options);
}

}  // namespace gestus::models
