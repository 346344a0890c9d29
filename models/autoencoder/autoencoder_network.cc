// Autoencoders on arrays of sequences.
#include <cstring>

#include "models/autoencoder/autoencoder.h"
#include "models/config.h"
#include "models/graph_network.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

class AutoencoderNetwork final : public GraphNetwork {
 public:
  const char* kind() const override { return "autoencoder"; }

 private:
  Status Load(const fb::Network& record, Binder& binder) override {
    const fb::AutoencoderConfig& f = *record.config_as_AutoencoderConfig();
    ConfigReader read("network " + record.name()->str());
    c_.length = read.Size("length", f.length(), 1, 1 << 12);
    c_.hidden = read.Size("hidden", f.hidden(), 1, 1 << 12);
    c_.alpha = read.Slope("alpha", f.alpha());
    c_.code = read.Enum<AeCode>("code", f.code(), fb::AeCode::MAX);
    c_.part = read.Enum<AePart>("part", f.part(), fb::AePart::MAX);
    GESTUS_RETURN_IF_ERROR(read.status());
    Result<Normalisation> values = ReadNormalisation(record, "values", 1);
    if (!values.ok()) return values.status();
    c_.values = *std::move(values);

    const std::int64_t h = c_.hidden;
    if (c_.Encodes()) BindEncoder(binder, "encoder", 1, 2 * h, h, &w_.encoder);
    if (c_.Decodes()) {
      BindDecoder(binder, "decoder", 2 * h, h, 2 * h, &w_.decoder);
      BindLinear(binder, "decoder.dense", 1, 2 * h, &w_.dense);
    }
    return {};
  }

  Signature Describe() const override {
    constexpr std::int64_t kAny = ArraySpec::kAny;
    const std::string unit = "as the statistics of values";
    const ArraySpec values =
        Spec("values", {kAny, c_.length}, {"sequences", "values"}, unit, "sequences to encode");
    const ArraySpec drawn = Spec("reconstruction", {kAny, c_.length}, {"sequences", "values"}, unit,
                                 "the sequences as the decoder draws them");
    const ArraySpec code =
        c_.code == AeCode::kVector
            ? Spec("code", {kAny, 2 * c_.hidden}, {"sequences", "features"}, "-", "h, eq. 5.1")
            : Spec("code", {kAny, c_.length, 2 * c_.hidden}, {"sequences", "steps", "features"},
                   "-", "h, eq. 5.1, at every step");
    switch (c_.part) {
      case AePart::kEncoder:
        return {{values}, {code}};
      case AePart::kDecoder:
        return {{code}, {drawn}};
      default:
        return {{values}, {code, drawn}};
    }
  }

  Graph Declare() const override {
    Graph g;
    Value h;
    if (c_.Encodes()) {
      h = AutoencoderEncoder(g, c_, w_, c_.values.Apply(g, g.Input("values", {c_.length, 1})));
      g.Output("code", h);
    } else {
      h = g.Input("code", {c_.CodeRows(), 2 * c_.hidden});
    }
    if (c_.Decodes())
      g.Output("reconstruction", c_.values.Undo(g, AutoencoderDecoder(g, c_, w_, h)));
    return g;
  }

  Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) override {
    const auto& [name, in] = *inputs.find(c_.Encodes() ? "values" : "code");
    const std::int64_t n = in.shape[0], code_size = c_.CodeRows() * 2 * c_.hidden;
    const std::int64_t in_size = c_.Encodes() ? c_.length : code_size;
    for (const ArraySpec& spec : signature().outputs) {
      std::vector<std::int64_t> shape = spec.shape;
      shape[0] = n;
      (*outputs)[spec.name] = MakeArray(std::move(shape));
    }
    items.progress.total = static_cast<std::size_t>(n);
    for (std::int64_t i = 0; i < n; ++i) {
      CopyIn(items.session.Input(name), in.f32.data() + i * in_size);
      items.Run();
      for (auto& [output, array] : *outputs) {
        const std::int64_t size = output == "code" ? code_size : c_.length;
        CopyOut(array.f32.data() + i * size, items.session.Output(output));
      }
    }
    return {};
  }

  AutoencoderConfig c_;
  AutoencoderWeights w_;
};

}  // namespace

Result<std::unique_ptr<Network>> MakeAutoencoderNetwork(std::shared_ptr<const WeightsFile> file,
                                                        const std::string& name,
                                                        const NetworkOptions& options) {
  return GraphNetwork::Make<AutoencoderNetwork>(std::move(file), name, options);
}

}  // namespace gestus::models
