// Whole networks at full size: AST on 64 and 1024 frames, ZS-MSTM 1.0's style encoder, generator
// and whole segment, with 1 and 2 threads.  `./run bench` makes the untrained weights that this
// reads from the folder in GESTUS_BENCH_WEIGHTS.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "models/network.h"
#include "models/zs_mstm/zs_mstm.h"

namespace gestus::models {
namespace {

std::string WeightsPath(const char* name) {
  const char* folder = std::getenv("GESTUS_BENCH_WEIGHTS");
  return std::string(folder != nullptr ? folder : "out/bench") + "/" + name;
}

std::vector<float> Noise(std::int64_t n) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<float> x(static_cast<std::size_t>(n));
  for (float& v : x) v = normal(random);
  return x;
}

double Flops(const Plan& plan) {
  double flops = 0;
  for (const Plan::Step& step : plan.steps()) {
    const int loop = step.node.loop;
    flops +=
        step.cost.flops *
        (loop < 0 ? 1.0 : static_cast<double>(plan.loops()[static_cast<std::size_t>(loop)].count));
  }
  return flops;
}

void SetRate(benchmark::State& state, double flops) {
  state.counters["GFLOP/s"] =
      benchmark::Counter(flops * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(kernels::BestTable().name);
}

void Ast(benchmark::State& state, const char* file_name) {
  const auto file = WeightsFile::Open(WeightsPath(file_name));
  if (!file.ok()) return state.SkipWithError(file.status().message().c_str());
  auto network = MakeNetwork(*file, "");
  if (!network.ok()) return state.SkipWithError(network.status().message().c_str());
  Array speech;
  speech.shape = {state.range(1), 128};
  speech.f32 = Noise(speech.shape[0] * 128);
  const RunOptions options{.threads = static_cast<int>(state.range(0))};
  RunReport profile;
  (void)(*network)->Run({{"speech", speech}}, {.profile = true}, &profile);
  double flops = 0;
  for (const OpProfile& op : profile.ops) flops += op.flops;
  for (auto _ : state) {
    RunReport report;
    const auto result = (*network)->Run({{"speech", speech}}, options, &report);
    if (!result.ok()) return state.SkipWithError(result.status().message().c_str());
    state.SetIterationTime(report.segment_seconds[0]);
  }
  SetRate(state, flops);
}

enum class Part { kStyle, kGenerator, kSegment };

void ZsMstmPart(benchmark::State& state, Part part, const char* file_name) {
  const auto file = WeightsFile::Open(WeightsPath(file_name));
  if (!file.ok()) return state.SkipWithError(file.status().message().c_str());
  const auto model = ZsMstm::Make(*file, "");
  if (!model.ok()) return state.SkipWithError(model.status().message().c_str());
  const auto agent = ZsMstm::NewAgent(*model, {.threads = static_cast<int>(state.range(0))});
  if (!agent.ok()) return state.SkipWithError(agent.status().message().c_str());
  const ZsMstmConfig& c = (*model)->config();
  const auto speech = Noise(c.frames * 128), text = Noise(c.frames * c.d_text);
  const auto pose = Noise(c.frames * c.d_pose);
  std::vector<float> out(pose.size());
  for (auto _ : state) {
    (*agent)->ResetStyle();
    if (part != Part::kGenerator)
      (*agent)->AddStyleSegment({speech.data(), text.data(), pose.data()});
    if (part != Part::kStyle) (*agent)->Generate(speech.data(), text.data(), out.data());
    benchmark::DoNotOptimize(out.data());
  }
  SetRate(state, (part != Part::kGenerator ? Flops(*(*model)->style_plan()) : 0) +
                     (part != Part::kStyle ? Flops(*(*model)->generator_plan()) : 0));
}

void Load(benchmark::State& state) {
  for (auto _ : state) {
    const auto file = WeightsFile::Open(WeightsPath("ast64.fb"));
    if (!file.ok()) return state.SkipWithError(file.status().message().c_str());
    benchmark::DoNotOptimize(MakeNetwork(*file, ""));
  }
}

#define GESTUS_THREADS ->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)

BENCHMARK_CAPTURE(Ast, ast_64_frames, "ast64.fb")
    ->ArgNames({"threads", "frames"})
    ->Args({1, 64})
    ->Args({2, 64})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(Ast, ast_1024_frames, "ast1024.fb")
    ->ArgNames({"threads", "frames"})
    ->Args({1, 1024})
    ->Args({2, 1024})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(ZsMstmPart, style_encoder, Part::kStyle, "zs_mstm1.fb")
GESTUS_THREADS->UseRealTime();
BENCHMARK_CAPTURE(ZsMstmPart, generator_autoregressive, Part::kGenerator, "zs_mstm1.fb")
GESTUS_THREADS->UseRealTime();
BENCHMARK_CAPTURE(ZsMstmPart, generator_one_pass, Part::kGenerator, "zs_mstm1_parallel.fb")
GESTUS_THREADS->UseRealTime();
BENCHMARK_CAPTURE(ZsMstmPart, whole_segment, Part::kSegment, "zs_mstm1.fb")
GESTUS_THREADS->UseRealTime();
BENCHMARK(Load)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gestus::models

BENCHMARK_MAIN();
