// Runs AST over the segments of a spectrogram.
#include "models/ast/ast_network.h"

#include <cstring>

#include "engine/plan.h"
#include "models/ast/ast.h"
#include "models/normalisation.h"
#include "models/run_support.h"
#include "models/segments.h"
#include "models/self_test.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

struct AstModel {
  std::shared_ptr<const WeightsFile> file;
  AstConfig config;
  AstWeights weights;
  Normalisation speech;
};

Graph AstGraph(const AstModel& m) {
  Graph g;
  const Value speech = g.Input("speech", {m.config.frames, m.config.mel_bins});
  g.Output("embedding", Ast(g, m.config, m.weights, m.speech.Apply(g, speech)));
  return g;
}

Signature MakeSignature(const AstConfig& c) {
  ArraySpec speech, embedding;
  speech.name = "speech";
  speech.shape = {ArraySpec::kAny, c.mel_bins};
  speech.axes = {"frames", "mel bins"};
  speech.unit = "ln power";
  speech.meaning = "log-mel spectrogram";
  embedding.name = "embedding";
  embedding.shape = {ArraySpec::kAny, c.d_out};
  embedding.axes = {"segments", "features"};
  embedding.unit = "-";
  embedding.meaning = "one vector for each segment of " + std::to_string(c.frames) + " frames";
  return {{speech}, {embedding}};
}

class AstNetwork final : public Network {
 public:
  AstNetwork(AstModel model, const kernels::KernelTable& kernels, const NetworkOptions& options)
      : model_(std::move(model)),
        cache_(kernels, model_.file),
        max_arena_bytes_(options.max_arena_bytes),
        signature_(MakeSignature(model_.config)) {}

  Status MakePlan(bool taps, std::shared_ptr<const Plan>* plan) {
    auto made =
        Plan::Make(AstGraph(model_), cache_, {.taps = taps, .max_arena_bytes = max_arena_bytes_});
    if (!made.ok()) return made.status().In(model_.file->path());
    *plan = *std::move(made);
    return {};
  }
  Status Init() { return MakePlan(false, &plan_); }

  const char* kind() const override { return "AST"; }
  const Signature& signature() const override { return signature_; }
  std::string PlanText() const override { return plan_->ToString(); }

  Result<Arrays> Run(const Arrays& inputs, const RunOptions& options, RunReport* report) override {
    GESTUS_RETURN_IF_ERROR(CheckOptions(options));
    GESTUS_RETURN_IF_ERROR(CheckInputs(signature_, inputs));
    std::shared_ptr<const Plan> plan = plan_;
    if (options.taps) GESTUS_RETURN_IF_ERROR(MakePlan(true, &plan));
    auto session = Session::Create(plan, {.threads = options.threads, .profile = options.profile});
    if (!session.ok()) return session.status();

    const AstConfig& c = model_.config;
    const Array& speech = inputs.at("speech");
    const std::int64_t total = speech.shape[0];
    const std::vector<Window> windows = Windows(total, c.frames);
    Arrays outputs;
    Array embedding = MakeArray({static_cast<std::int64_t>(windows.size()), c.d_out});
    Progress progress{0, windows.size()};
    for (std::size_t i = 0; i < windows.size(); ++i) {
      CopyWindow(speech.f32.data(), total, c.mel_bins, windows[i].begin, c.frames,
                 (*session)->Input("speech").f32);
      TimedRun(options, report, [&] { (*session)->Run(); });
      std::memcpy(embedding.f32.data() + static_cast<std::int64_t>(i) * c.d_out,
                  (*session)->Output("embedding").f32,
                  static_cast<std::size_t>(c.d_out) * sizeof(float));
      progress.Step(options);
    }
    GESTUS_RETURN_IF_ERROR(CheckFinite("embedding", embedding, Code::kNonFinite));
    outputs["embedding"] = std::move(embedding);
    if (options.taps) CopyTaps(**session, &outputs);
    AddProfiles({session->get()}, report);
    if (report != nullptr) {
      report->frames = static_cast<std::size_t>(total);
      const std::string note = DescribeLastWindow("speech", total, c.frames);
      if (!note.empty()) report->notes.push_back(note);
    }
    return outputs;
  }

 private:
  AstModel model_;
  WeightCache cache_;
  std::uint64_t max_arena_bytes_;
  Signature signature_;
  std::shared_ptr<const Plan> plan_;
};

}  // namespace

Result<std::unique_ptr<Network>> MakeAstNetwork(std::shared_ptr<const WeightsFile> file,
                                                const std::string& name,
                                                const NetworkOptions& options) {
  const fb::Network& network = *file->FindNetwork(name);
  Result<AstConfig> config = ReadAstConfig(*network.config_as_AstConfig(),
                                           file->path() + ": network " + network.name()->str());
  if (!config.ok()) return config.status();
  Result<Normalisation> speech = ReadNormalisation(network, "speech", config->mel_bins);
  if (!speech.ok()) return speech.status().In(file->path());

  AstModel model{file, *std::move(config), {}, *std::move(speech)};
  Binder binder(*file, network.prefix()->str());
  BindAst(binder, model.config, &model.weights);
  UseSelfTest(binder, network);
  GESTUS_RETURN_IF_ERROR(binder.Finish());
  auto made = std::make_unique<AstNetwork>(
      std::move(model), options.kernels != nullptr ? *options.kernels : kernels::BestTable(),
      options);
  GESTUS_RETURN_IF_ERROR(made->Init());
  return std::unique_ptr<Network>(std::move(made));
}

}  // namespace gestus::models
