// Stacked LSTMs, the last step, one unit.
#include "models/classifier/classifier.h"

#include "models/config.h"
#include "models/graph_network.h"
#include "weights_generated.h"

namespace gestus::models {

Value Classifier(Graph& g, const ClassifierWeights& w, Value motion) {
  Value h = motion;                                              // (T, d_in)
  for (const LstmWeights& layer : w.lstm) h = g.Lstm(h, layer);  // (T, hidden)
  g.Tap("lstm", h);
  const Value last = g.Rows(h, g.shape(h).Rows() - 1, 1);
  return g.Linear(last, w.dense, Activation::kSigmoid);
}

namespace {

class ClassifierNetwork final : public GraphNetwork {
 public:
  const char* kind() const override { return "classifier C"; }

 private:
  Status Load(const fb::Network& record, Binder& binder) override {
    const fb::ClassifierConfig& f = *record.config_as_ClassifierConfig();
    ConfigReader read("network " + record.name()->str());
    c_.frames = read.Size("frames", f.frames(), 1, 1 << 12);
    c_.d_in = read.Size("d_in", f.d_in(), 1, 1 << 12);
    c_.layers = read.Size("layers", f.layers(), 1, 32);
    c_.hidden = read.Size("hidden", f.hidden(), 1, 1 << 13);
    c_.frame_rate = read.Rate("frame_rate", f.frame_rate());
    GESTUS_RETURN_IF_ERROR(read.status());
    Result<Normalisation> motion = ReadNormalisation(record, "motion", c_.d_in);
    if (!motion.ok()) return motion.status();
    c_.motion = *std::move(motion);
    BindLstmStack(binder, "lstm", c_.layers, c_.d_in, c_.hidden, &w_.lstm);
    BindLinear(binder, "dense", 1, c_.hidden, &w_.dense);
    return {};
  }

  Signature Describe() const override {
    return {{Spec("motion", {ArraySpec::kAny, c_.d_in}, {"frames", "coordinates"},
                  "as the motion statistics", "poses and faces side by side")},
            {Spec("strength", {ArraySpec::kAny}, {"segments"}, "0 source style to 1 target style",
                  "whose style each segment carries")}};
  }

  Graph Declare() const override {
    Graph g;
    g.Output("strength",
             Classifier(g, w_, c_.motion.Apply(g, g.Input("motion", {c_.frames, c_.d_in}))));
    return g;
  }

  Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) override {
    RunWindows(inputs.at("motion"), "motion", c_.frames, "strength", items, outputs);
    Array& strength = (*outputs)["strength"];  // one value a segment
    strength.shape.pop_back();
    return {};
  }
  ClassifierConfig c_;
  ClassifierWeights w_;
};

}  // namespace

Result<std::unique_ptr<Network>> MakeClassifierNetwork(std::shared_ptr<const WeightsFile> file,
                                                       const std::string& name,
                                                       const NetworkOptions& options) {
  return GraphNetwork::Make<ClassifierNetwork>(std::move(file), name, options);
}

}  // namespace gestus::models
