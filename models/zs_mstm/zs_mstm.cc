// Building ZS-MSTM from a weights file, and running it for one agent.
#include "models/zs_mstm/zs_mstm.h"

#include <cstring>

#include "engine/thread_pool.h"
#include "models/run_support.h"
#include "models/zs_mstm/networks.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

std::size_t Elements(const ValueView& v) { return static_cast<std::size_t>(v.shape.NumElements()); }

}  // namespace

Result<std::shared_ptr<const ZsMstm>> ZsMstm::Make(std::shared_ptr<const WeightsFile> file,
                                                   const std::string& name,
                                                   const ZsMstmOptions& options) {
  const fb::Network* network = file->FindNetwork(name);
  if (network == nullptr || (network->config_as_ZsMstm1Config() == nullptr &&
                             network->config_as_ZsMstm2Config() == nullptr))
    return Status(Code::kBadWeights,
                  file->path() + ": no ZS-MSTM network" + (name.empty() ? "" : " called " + name));
  std::shared_ptr<ZsMstm> model(new ZsMstm);
  model->file_ = file;
  GESTUS_RETURN_IF_ERROR(LoadZsMstm(*file, *network, &model->config_, &model->weights_));

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
  return std::shared_ptr<const ZsMstm>(std::move(model));
}

Result<std::unique_ptr<ZsMstmAgent>> ZsMstm::NewAgent(std::shared_ptr<const ZsMstm> model,
                                                      const SessionOptions& options) {
  std::unique_ptr<ZsMstmAgent> agent(new ZsMstmAgent);
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
  agent->style_face_ = s.Input("face");
  agent->style_tags_ = s.Input("tags");
  agent->style_out_ = s.Output("style");
  agent->speech_ = g.Input("speech");
  agent->text_ = g.Input("text");
  agent->style_ = g.Input("style").f32;
  agent->pose_ = g.Output("pose");
  agent->face_ = g.Output("face");
  agent->model_ = std::move(model);
  return agent;
}

void ZsMstmAgent::ResetStyle() noexcept {
  style_segments_ = 0;
  std::memset(style_, 0, Elements(style_out_) * sizeof(float));
}

void ZsMstmAgent::AddStyleSegment(const StyleSegment& segment) noexcept {
  CopyIn(style_speech_, segment.speech);
  CopyIn(style_text_, segment.text);
  CopyIn(style_pose_, segment.pose);
  if (style_face_.f32 != nullptr) {
    CopyIn(style_face_, segment.face);
    CopyIn(style_tags_, segment.tags);
  }
  style_session_->Run();
  // Running mean, so that nothing needs to be kept of the segments before.
  const float weight = 1.0f / static_cast<float>(++style_segments_);
  for (std::size_t i = 0; i < Elements(style_out_); ++i)
    style_[i] += (style_out_.f32[i] - style_[i]) * weight;
}

void ZsMstmAgent::SetStyle(const float* style) noexcept {
  style_segments_ = 1;
  std::memcpy(style_, style, Elements(style_out_) * sizeof(float));
}

void ZsMstmAgent::Generate(const float* speech, const float* text, float* pose,
                           float* face) noexcept {
  CopyIn(speech_, speech);
  CopyIn(text_, text);
  generator_session_->Run();
  CopyOut(pose, pose_);
  if (face != nullptr && face_.f32 != nullptr) CopyOut(face, face_);
}

}  // namespace gestus::models
