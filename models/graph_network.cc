// Loading, planning and running around a model's own graph.
#include "models/graph_network.h"

#include "models/segments.h"
#include "models/self_test.h"
#include "weights_generated.h"

namespace gestus::models {

void GraphNetwork::Items::Run() {
  TimedRun(options, report, [this] { session.Run(); });
  progress.Step(options);
}

void GraphNetwork::RunWindows(const Array& input, const std::string& input_name,
                              std::int64_t length, const std::string& output_name, Items& items,
                              Arrays* outputs) {
  const std::int64_t total = input.shape[0], cols = input.shape[1];
  const std::vector<Window> windows = Windows(total, length);
  const ValueView out = items.session.Output(output_name);
  const std::int64_t width = out.shape.Cols();
  Array rows = MakeArray({static_cast<std::int64_t>(windows.size()), width});
  items.progress.total = windows.size();
  float* to = rows.f32.data();
  for (const Window& w : windows) {
    CopyWindow(input.f32.data(), total, cols, w.begin, length, items.session.Input(input_name).f32);
    items.Run();
    CopyOut(to, out);
    to += width;
  }
  (*outputs)[output_name] = std::move(rows);
  AddNote(items.report, DescribeLastWindow(input_name, total, length));
}

Status GraphNetwork::Init(std::shared_ptr<const WeightsFile> file, const std::string& name,
                          const NetworkOptions& options) {
  file_ = std::move(file);
  max_arena_bytes_ = options.max_arena_bytes;
  cache_ = std::make_unique<WeightCache>(
      options.kernels != nullptr ? *options.kernels : kernels::BestTable(), file_);
  const fb::Network& record = *file_->FindNetwork(name);
  Binder binder(*file_, record.prefix()->str());
  GESTUS_RETURN_IF_ERROR(Load(record, binder).In(file_->path()));
  UseSelfTest(binder, record);
  GESTUS_RETURN_IF_ERROR(binder.Finish());
  signature_ = Describe();
  if (!options.plan) return {};
  auto plan = MakePlan(false);
  if (!plan.ok()) return plan.status();
  plan_ = *std::move(plan);
  return {};
}

Result<std::shared_ptr<const Plan>> GraphNetwork::MakePlan(bool taps) {
  auto plan = Plan::Make(Declare(), *cache_, {.taps = taps, .max_arena_bytes = max_arena_bytes_});
  if (!plan.ok()) return plan.status().In(file_->path());
  return plan;
}

Result<Arrays> GraphNetwork::Run(const Arrays& inputs, const RunOptions& options,
                                 RunReport* report) {
  if (plan_ == nullptr) return NotPlanned();
  GESTUS_RETURN_IF_ERROR(CheckOptions(options));
  GESTUS_RETURN_IF_ERROR(CheckInputs(signature_, inputs));
  std::shared_ptr<const Plan> plan = plan_;
  if (options.taps) {
    auto tapped = MakePlan(true);
    if (!tapped.ok()) return tapped.status();
    plan = *std::move(tapped);
  }
  auto session = Session::Create(plan, SessionOptionsOf(options));
  if (!session.ok()) return session.status();

  Items items{**session, options, report, {}};
  Arrays outputs;
  GESTUS_RETURN_IF_ERROR(RunItems(inputs, items, &outputs));
  for (const auto& [name, array] : outputs)
    GESTUS_RETURN_IF_ERROR(CheckFinite(name, array, Code::kNonFinite));
  if (options.taps) CopyTaps(**session, &outputs);
  AddProfiles({session->get()}, report);
  return outputs;
}

}  // namespace gestus::models
