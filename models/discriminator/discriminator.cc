// A regression by a few dense layers.
#include "models/discriminator/discriminator.h"

#include "models/config.h"
#include "models/graph_network.h"
#include "weights_generated.h"

namespace gestus::models {

Value Discriminator(Graph& g, const DiscriminatorConfig& c, const DiscriminatorWeights& w,
                    Value h_content) {
  Value x = Pool(g, c.pool, h_content);  // (1, d_content)
  for (std::size_t i = 0; i < w.layers.size(); ++i) {
    x = g.Linear(x, w.layers[i], Activation::kLeakyRelu, c.alpha);  // (1, hidden)
    g.Tap("hidden." + std::to_string(i), x);
  }
  return g.Linear(x, w.output);
}

namespace {

class DiscriminatorNetwork final : public GraphNetwork {
 public:
  const char* kind() const override { return "discriminator Dis"; }

 private:
  Status Load(const fb::Network& record, Binder& binder) override {
    const fb::DiscriminatorConfig& f = *record.config_as_DiscriminatorConfig();
    ConfigReader read("network " + record.name()->str());
    c_.rows = read.Size("rows", f.rows(), 1, 1 << 12);
    c_.d_content = read.Size("d_content", f.d_content(), 1, 1 << 14);
    c_.d_style = read.Size("d_style", f.d_style(), 1, 1 << 14);
    c_.pool = read.Enum<StylePool>("pool", f.pool(), fb::StylePool::MAX);
    c_.layers = read.Size("layers", f.layers(), 0, 64);
    c_.hidden = read.Size("hidden", f.hidden(), 1, 1 << 14);
    c_.alpha = read.Slope("alpha", f.alpha());
    GESTUS_RETURN_IF_ERROR(read.status());
    std::int64_t width = c_.d_content;
    w_.layers.resize(static_cast<std::size_t>(c_.layers));
    for (std::size_t i = 0; i < w_.layers.size(); ++i) {
      BindLinear(binder, "layers." + std::to_string(i), c_.hidden, width, &w_.layers[i]);
      width = c_.hidden;
    }
    BindLinear(binder, "output", c_.d_style, width, &w_.output);
    return {};
  }

  Signature Describe() const override {
    return {{Spec("content", {ArraySpec::kAny, c_.d_content}, {"rows", "features"}, "-",
                  "h_content, as infer-cli --taps gives it")},
            {Spec("style", {ArraySpec::kAny, c_.d_style}, {"segments", "values"}, "-",
                  "h_style as it can be told from the content of each segment")}};
  }

  Graph Declare() const override {
    Graph g;
    g.Output("style", Discriminator(g, c_, w_, g.Input("content", {c_.rows, c_.d_content})));
    return g;
  }

  Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) override {
    RunWindows(inputs.at("content"), "content", c_.rows, "style", items, outputs);
    return {};
  }
  DiscriminatorConfig c_;
  DiscriminatorWeights w_;
};

}  // namespace

Result<std::unique_ptr<Network>> MakeDiscriminatorNetwork(std::shared_ptr<const WeightsFile> file,
                                                          const std::string& name,
                                                          const NetworkOptions& options) {
  return GraphNetwork::Make<DiscriminatorNetwork>(std::move(file), name, options);
}

}  // namespace gestus::models
