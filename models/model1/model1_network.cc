// Model 1 on arrays of words.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "models/config.h"
#include "models/graph_network.h"
#include "models/model1/model1.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

class Model1Network final : public GraphNetwork {
 public:
  const char* kind() const override { return "Model 1"; }

 private:
  Status Load(const fb::Network& record, Binder& binder) override {
    const fb::Model1Config& f = *record.config_as_Model1Config();
    ConfigReader read("network " + record.name()->str());
    c_.f0_length = read.Size("f0_length", f.f0_length(), 1, 1 << 12);
    c_.d_text = read.Size("d_text", f.d_text(), 1, 1 << 14);
    c_.text_rows = read.Size("text_rows", f.text_rows(), 1, 1 << 10);
    c_.ae_hidden = read.Size("ae_hidden", f.ae_hidden(), 1, 1 << 12);
    c_.ae_alpha = read.Slope("ae_alpha", f.ae_alpha());
    c_.code = read.Enum<AeCode>("code", f.code(), fb::AeCode::MAX);
    c_.hidden1 = read.Size("hidden1", f.hidden1(), 1, 1 << 12);
    c_.hidden2 = read.Size("hidden2", f.hidden2(), 1, 1 << 12);
    c_.alpha = read.Slope("alpha", f.alpha());
    c_.out_length = read.Size("out_length", f.out_length(), 1, 1 << 12);
    for (const fb::Channel* channel : *f.channels()) ReadChannel(read, *channel, &c_.channels);
    if (c_.channels.empty()) read.Fail("channels", "none", "one or more");
    GESTUS_RETURN_IF_ERROR(read.status());
    for (auto [stream, columns, to] :
         {std::tuple("f0", std::int64_t{1}, &c_.f0), std::tuple("text", c_.d_text, &c_.text)}) {
      Result<Normalisation> statistics = ReadNormalisation(record, stream, columns);
      if (!statistics.ok()) return statistics.status();
      *to = *std::move(statistics);
    }
    Bind(binder);
    return {};
  }

  void Bind(Binder& binder) {
    const std::int64_t ae = c_.ae_hidden;
    BindEncoder(binder, "e1_speech", 1, 2 * ae, ae, &w_.e1_speech);
    BindEncoder(binder, "e2_speech", 2 * ae, c_.hidden1, c_.hidden2, &w_.e2_speech);
    BindEncoder(binder, "e_text", c_.d_text, c_.hidden1, c_.hidden2, &w_.e_text);
    w_.faces.resize(c_.channels.size());
    for (std::size_t n = 0; n < w_.faces.size(); ++n) {
      const std::string channel = std::to_string(n);
      BindDecoder(binder, "d_face." + channel, 4 * c_.hidden2, ae, 2 * ae, &w_.faces[n].decoder);
      BindLinear(binder, "heads." + channel, c_.channels[n].Tokens(), 2 * ae, &w_.faces[n].head);
    }
  }

  Signature Describe() const override {
    constexpr std::int64_t kAny = ArraySpec::kAny;
    const ArraySpec f0 = Spec("f0", {kAny, c_.f0_length}, {"words", "values"}, "Hz",
                              "f0 of each word, zeros behind its end");
    const char* meaning = "BERT features of each word";
    const ArraySpec text =
        c_.text_rows == 1 ? Spec("text", {kAny, c_.d_text}, {"words", "features"}, "-", meaning)
                          : Spec("text", {kAny, c_.text_rows, c_.d_text},
                                 {"words", "rows", "features"}, "-", meaning);
    return {{f0, text}, FaceSpecs(c_.channels, "words", c_.out_length)};
  }

  Graph Declare() const override {
    Graph g;
    const Value f0 = c_.f0.Apply(g, g.Input("f0", {c_.f0_length, 1}));
    const Value text = c_.text.Apply(g, g.Input("text", {c_.text_rows, c_.d_text}));
    const Value h = Model1Encoder(g, c_, w_, f0, text);
    for (std::size_t n = 0; n < c_.channels.size(); ++n)
      g.Output(std::to_string(n), Model1Decoder(g, c_, w_, n, h));
    return g;
  }

  Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) override {
    GESTUS_RETURN_IF_ERROR(CheckSameRows(inputs, "text", "f0", "words"));
    const Array &f0 = inputs.at("f0"), &text = inputs.at("text");
    const std::int64_t words = f0.shape[0];
    const auto channels = static_cast<std::int64_t>(c_.channels.size());
    Array tokens = MakeArray({words, c_.out_length, channels}, DType::kI32);
    items.progress.total = static_cast<std::size_t>(words);
    for (std::int64_t word = 0; word < words; ++word) {
      CopyIn(items.session.Input("f0"), f0.f32.data() + word * c_.f0_length);
      CopyIn(items.session.Input("text"), text.f32.data() + word * c_.text_rows * c_.d_text);
      items.Run();
      for (std::int64_t n = 0; n < channels; ++n) {
        const ValueView p = items.session.Output(std::to_string(n));
        for (std::int64_t step = 0; step < c_.out_length; ++step) {
          const float* row = p.f32 + step * p.row_stride;
          if (!std::all_of(row, row + p.shape.Cols(), [](float v) { return std::isfinite(v); }))
            return Status(Code::kNonFinite, "face: no probabilities for word " +
                                                std::to_string(word) + ", expected finite values");
          tokens.i32[static_cast<std::size_t>((word * c_.out_length + step) * channels + n)] =
              static_cast<std::int32_t>(std::max_element(row, row + p.shape.Cols()) - row);
        }
      }
    }
    AddFaces(c_.channels, std::move(tokens), outputs);
    return {};
  }

  Model1Config c_;
  Model1Weights w_;
};

}  // namespace

Result<std::unique_ptr<Network>> MakeModel1Network(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const NetworkOptions& options) {
  return GraphNetwork::Make<Model1Network>(std::move(file), name, options);
}

}  // namespace gestus::models
