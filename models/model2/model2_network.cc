// Model 2 on arrays of words of any length.
#include <algorithm>
#include <cmath>
#include <random>

#include "models/graph_network.h"
#include "models/model2/model2.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

class Model2Network final : public GraphNetwork {
 public:
  const char* kind() const override { return "Model 2"; }

 private:
  Status Load(const fb::Network& record, Binder& binder) override {
    Result<Model2Config> config =
        ReadModel2Config(*record.config_as_Model2Config(), "network " + record.name()->str());
    if (!config.ok()) return config.status();
    c_ = *std::move(config);
    Result<Normalisation> text = ReadNormalisation(record, "text", c_.d_text);
    if (!text.ok()) return text.status();
    c_.text = *std::move(text);
    BindModel2(binder, c_, &w_);
    return binder.status();
  }

  Signature Describe() const override {
    constexpr std::int64_t kAny = ArraySpec::kAny;
    return {
        {Spec("f0", {kAny, c_.f0_length}, {"words", "values"}, "Hz",
              "f0 of each word, zeros where unvoiced and behind its end"),
         Spec("text", {kAny, c_.d_text}, {"words", "features"}, "-", "BERT features of each word")},
        FaceSpecs(c_.channels, "windows", c_.max_out)};
  }

  Graph Declare() const override {
    Graph g;
    const auto channels = static_cast<std::int64_t>(c_.channels.size());
    const Value f0 = g.Input("f0", {c_.max_words * c_.f0_length}, DType::kI32);
    const Value text = g.Input("text", {c_.max_words, c_.d_text});
    const Value controls = g.Input("controls", {1, 2}), u = g.Input("u", {c_.max_out, channels});
    const Value speech = F0Encoder(g, c_, w_, f0);
    const Value h_att = CrossModality(g, c_, w_, speech, c_.text.Apply(g, text));
    const std::vector<Value> tokens = FaceDecoder(g, c_, w_, h_att, controls, u);
    for (std::size_t n = 0; n < tokens.size(); ++n) g.Output(std::to_string(n), tokens[n]);
    return g;
  }

  Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) override;
  void FeedWindow(const Arrays& inputs, std::int64_t first, Session& session) const;

  Model2Config c_;
  Model2Weights w_;
};

/// Words from `first` on; behind the last one stand, as in training, words without f0 and meaning.
void Model2Network::FeedWindow(const Arrays& inputs, std::int64_t first, Session& session) const {
  const Array &f0 = inputs.at("f0"), &text = inputs.at("text");
  const std::int64_t words = std::min(c_.max_words, f0.shape[0] - first);
  const ValueView tokens = session.Input("f0"), rows = session.Input("text");
  std::fill_n(tokens.i32, c_.max_words * c_.f0_length, 0);
  std::fill_n(rows.f32, c_.max_words * c_.d_text, 0.0f);
  std::transform(f0.f32.begin() + first * c_.f0_length,
                 f0.f32.begin() + (first + words) * c_.f0_length, tokens.i32,
                 [this](float hz) { return c_.F0Token(hz); });
  std::copy_n(text.f32.begin() + first * c_.d_text, words * c_.d_text, rows.f32);
}

Status Model2Network::RunItems(const Arrays& inputs, Items& items, Arrays* outputs) {
  GESTUS_RETURN_IF_ERROR(CheckSameRows(inputs, "text", "f0", "words"));
  const std::int64_t words = inputs.at("f0").shape[0];
  Session& session = items.session;
  const auto channels = static_cast<std::int64_t>(c_.channels.size());
  const std::int64_t windows = (words + c_.max_words - 1) / c_.max_words;
  const Sampling& sampling = items.options.sampling;
  session.Input("controls").f32[0] = sampling.temperature;
  session.Input("controls").f32[1] = static_cast<float>(sampling.top_k);
  std::mt19937 random(sampling.seed);
  Array tokens = MakeArray({windows, c_.max_out, channels}, DType::kI32);
  items.progress.total = static_cast<std::size_t>(windows);
  for (std::int64_t window = 0; window < windows; ++window) {
    FeedWindow(inputs, window * c_.max_words, session);
    const ValueView u = session.Input("u");
    std::generate_n(u.f32, c_.max_out * channels,
                    [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; });
    items.Run();
    for (std::int64_t n = 0; n < channels; ++n) {
      const std::int32_t* picked = session.Output(std::to_string(n)).i32;
      // Where logits are not finite, Graph::Pick can choose nothing.
      if (std::any_of(picked, picked + c_.max_out, [](std::int32_t token) { return token < 0; }))
        return Status(Code::kNonFinite, "face: no probabilities for window " +
                                            std::to_string(window) + ", expected finite values");
      for (std::int64_t step = 0; step < c_.max_out; ++step)
        tokens.i32[static_cast<std::size_t>((window * c_.max_out + step) * channels + n)] =
            picked[step];
    }
  }
  AddFaces(c_.channels, std::move(tokens), outputs);
  if (words > c_.max_words)
    AddNote(items.report, "f0: " + std::to_string(words) + " words ran in " +
                              std::to_string(windows) + " windows of at most " +
                              std::to_string(c_.max_words) + " that do not see one another");
  return {};
}

}  // namespace

Result<std::unique_ptr<Network>> MakeModel2Network(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const NetworkOptions& options) {
  return GraphNetwork::Make<Model2Network>(std::move(file), name, options);
}

}  // namespace gestus::models
