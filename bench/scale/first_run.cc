// Plans a network, makes its session, fills its inputs.
#include "bench/scale/first_run.h"

#include <algorithm>

#include "bench/peers/networks.h"
#include "weights_generated.h"

namespace gestus::bench {
namespace {

constexpr std::int64_t kTokens = 32;

}  // namespace

Status FirstRun::Plan(const std::shared_ptr<const WeightsFile>& file) {
  const fb::Network* network = file->FindNetwork("");
  if (network != nullptr && network->config_type() == fb::Config::ZsMstm1Config) {
    auto model = models::ZsMstm::Make(file, "");
    if (model.ok()) model_ = *std::move(model);
    return model.status();
  }
  auto graph = DeclareNetwork(*file, [](const std::string&) { return kTokens; });
  if (!graph.ok()) return graph.status();
  WeightCache cache(kernels::BestTable(), file);
  auto plan = gestus::Plan::Make(*std::move(graph), cache);
  if (plan.ok()) plan_ = *std::move(plan);
  return plan.status();
}

Status FirstRun::MakeSession(int threads) {
  if (model_ != nullptr) {
    auto agent = models::ZsMstm::NewAgent(model_, {.threads = threads});
    if (!agent.ok()) return agent.status();
    agent_ = *std::move(agent);
    const models::ZsMstmConfig& c = model_->config();
    const auto frames = static_cast<std::size_t>(c.WindowFrames());
    speech_.assign(frames * static_cast<std::size_t>(c.ast_content.mel_bins), -4.0f);
    text_.assign(frames * static_cast<std::size_t>(c.d_text), 0.25f);
    pose_.resize(frames * static_cast<std::size_t>(c.d_pose));
    return {};
  }
  auto session = Session::Create(plan_, {.threads = threads});
  if (!session.ok()) return session.status();
  session_ = *std::move(session);
  for (const NamedValue& input : plan_->inputs()) {
    const ValueView view = session_->Input(input.name);
    const auto count = static_cast<std::size_t>(view.shape.NumElements());
    if (input.name == "ids")
      std::fill_n(view.i32, count, 2000);
    else
      std::fill_n(view.f32, count, -4.0f);
  }
  return {};
}

void FirstRun::Run() {
  if (session_ != nullptr)
    session_->Run();
  else
    agent_->Generate(speech_.data(), text_.data(), pose_.data());
}

float FirstRun::FirstValue() const {
  if (session_ == nullptr) return pose_[0];
  return *session_->Output(plan_->outputs()[0].name).f32;
}

}  // namespace gestus::bench
