// Building ZS-MSTM 1.0 from a weights file, and running it for one agent.
#include "models/zs_mstm1/zs_mstm1.h"

#include <cstring>

#include "engine/thread_pool.h"
#include "models/self_test.h"
#include "models/zs_mstm1/networks.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

std::size_t Elements(const ValueView& v) { return static_cast<std::size_t>(v.shape.NumElements()); }

void CopyIn(const ValueView& to, const float* from) {
  std::memcpy(to.f32, from, Elements(to) * sizeof(float));
}

void CopyRows(float* to, const ValueView& from) {
  const auto rows = from.shape.Rows(), cols = from.shape.Cols();
  for (std::int64_t r = 0; r < rows; ++r)
    std::memcpy(to + r * cols, from.f32 + r * from.row_stride,
                static_cast<std::size_t>(cols) * sizeof(float));
}

}  // namespace

Result<std::shared_ptr<const ZsMstm1>> ZsMstm1::Make(std::shared_ptr<const WeightsFile> file,
                                                     const std::string& name,
                                                     const ZsMstm1Options& options) {
  const fb::Network* network = file->FindNetwork(name);
  if (network == nullptr || network->config_as_ZsMstm1Config() == nullptr)
    return Status(Code::kBadWeights, file->path() + ": no ZS-MSTM 1.0 network" +
                                         (name.empty() ? "" : " called " + name));
  Result<ZsMstm1Config> config = ReadZsMstm1Config(*network);
  if (!config.ok()) return config.status().In(file->path());

  std::shared_ptr<ZsMstm1> model(new ZsMstm1);
  model->file_ = file;
  model->config_ = *std::move(config);
  Binder binder(*file, network->prefix()->str());
  BindZsMstm1(binder, model->config_, &model->weights_);
  UseSelfTest(binder, *network);
  GESTUS_RETURN_IF_ERROR(binder.Finish());

  const kernels::KernelTable& table =
      options.kernels != nullptr ? *options.kernels : kernels::BestTable();
  WeightCache cache(table, file);
  for (auto [graph, plan] :
       {std::pair(StyleGraph(model->config_, model->weights_), &model->style_plan_),
        std::pair(GeneratorGraph(model->config_, model->weights_), &model->generator_plan_)}) {
    Result<std::shared_ptr<const Plan>> made = Plan::Make(std::move(graph), cache, options.plan);
    if (!made.ok()) return made.status().In(file->path());
    *plan = *std::move(made);
  }
  return std::shared_ptr<const ZsMstm1>(std::move(model));
}

Result<std::unique_ptr<ZsMstm1Agent>> ZsMstm1::NewAgent(std::shared_ptr<const ZsMstm1> model,
                                                        const SessionOptions& options) {
  std::unique_ptr<ZsMstm1Agent> agent(new ZsMstm1Agent);
  SessionOptions shared = options;
  if (shared.threads > 1 && shared.threads <= kMaxThreads && shared.pool == nullptr)
    shared.pool = std::make_shared<ThreadPool>(shared.threads);
  for (auto [plan, session] : {std::pair(model->style_plan_, &agent->style_session_),
                               std::pair(model->generator_plan_, &agent->generator_session_)}) {
    Result<std::unique_ptr<Session>> made = Session::Create(plan, shared);
    if (!made.ok()) return made.status();
    *session = *std::move(made);
  }
  Session &s = *agent->style_session_, &g = *agent->generator_session_;
  agent->style_speech_ = s.Input("speech");
  agent->style_text_ = s.Input("text");
  agent->style_pose_ = s.Input("pose");
  agent->style_out_ = s.Output("style");
  agent->speech_ = g.Input("speech");
  agent->text_ = g.Input("text");
  agent->style_ = g.Input("style").f32;
  agent->pose_ = g.Output("pose");
  agent->model_ = std::move(model);
  return agent;
}

void ZsMstm1Agent::ResetStyle() noexcept {
  style_segments_ = 0;
  std::memset(style_, 0, Elements(style_out_) * sizeof(float));
}

void ZsMstm1Agent::AddStyleSegment(const float* speech, const float* text,
                                   const float* pose) noexcept {
  CopyIn(style_speech_, speech);
  CopyIn(style_text_, text);
  CopyIn(style_pose_, pose);
  style_session_->Run();
  // Running mean, so that nothing needs to be kept of the segments before.
  const float weight = 1.0f / static_cast<float>(++style_segments_);
  for (std::size_t i = 0; i < Elements(style_out_); ++i)
    style_[i] += (style_out_.f32[i] - style_[i]) * weight;
}

void ZsMstm1Agent::SetStyle(const float* style) noexcept {
  style_segments_ = 1;
  std::memcpy(style_, style, Elements(style_out_) * sizeof(float));
}

void ZsMstm1Agent::Generate(const float* speech, const float* text, float* pose) noexcept {
  CopyIn(speech_, speech);
  CopyIn(text_, text);
  generator_session_->Run();
  CopyRows(pose, pose_);
}

}  // namespace gestus::models
