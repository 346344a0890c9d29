// The prosody front end on 4.27 s of a voice, one segment of the gesture models: pitch in both
// modes at the usual rates, voice quality, and pitch pushed in pieces of 10 ms as it comes from a
// microphone.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "kernels/kernels.h"
#include "models/prosody/contour.h"
#include "models/prosody/swipe.h"
#include "models/prosody/voice_quality.h"

namespace gestus::prosody {
namespace {

constexpr double kSeconds = 64.0 / 15;

// A gliding voice in a little noise; a second in four is silent.
std::vector<float> Voice(double rate) {
  std::mt19937 random(1);
  std::normal_distribution<double> breath(0, 0.002);
  std::vector<float> x(static_cast<std::size_t>(kSeconds * rate));
  double phase = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) / rate;
    phase = std::fmod(phase + 2 * std::numbers::pi * (150 + 40 * std::sin(3 * t)) / rate,
                      2 * std::numbers::pi);
    double sum = breath(random);
    for (int k = 1; k <= 20 && std::fmod(t, 4) < 3; ++k) sum += 0.05 * std::cos(k * phase) / k;
    x[i] = static_cast<float>(sum);
  }
  return x;
}

template <class Stage>
void Measure(benchmark::State& state, Result<Stage> stage, double rate, std::size_t piece) {
  if (!stage.ok()) return state.SkipWithError(stage.status().message().c_str());
  const std::vector<float> x = Voice(rate);
  std::vector<float> rows((stage->MaxRows(x.size()) + stage->MaxRowsAtFinish()) * Stage::kColumns);
  std::size_t count = 0;
  for (auto _ : state) {
    count = 0;
    for (std::size_t at = 0; at < x.size(); at += piece)
      count += stage->Push(x.data() + at, std::min(piece, x.size() - at),
                           rows.data() + count * Stage::kColumns);
    count += stage->Finish(rows.data() + count * Stage::kColumns);
    benchmark::DoNotOptimize(rows.data());
  }
  if (count != 427) return state.SkipWithError("wrong number of rows");
  state.counters["times_real_time"] =
      benchmark::Counter(kSeconds, benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(kernels::BestTable().name);
}

void Pitch(benchmark::State& state, SwipeMode mode) {
  const auto rate = static_cast<double>(state.range(0));
  Measure(state, Swipe::Make({.sample_rate = rate, .mode = mode}), rate, 1 << 20);
}

void PitchLive(benchmark::State& state) {
  const auto rate = static_cast<double>(state.range(0));
  Measure(state, Swipe::Make({.sample_rate = rate}), rate, static_cast<std::size_t>(rate / 100));
}

void Quality(benchmark::State& state) {
  const auto rate = static_cast<double>(state.range(0));
  Measure(state, VoiceQuality::Make({.swipe = {.sample_rate = rate}}), rate, 1 << 20);
}

void Setup(benchmark::State& state) {
  const auto rate = static_cast<double>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(Swipe::Make({.sample_rate = rate}));
}

void Words(benchmark::State& state) {
  std::vector<float> f0(427);
  for (std::size_t j = 0; j < f0.size(); ++j) f0[j] = j % 10 < 7 ? 120 : 0;
  std::vector<WordSpan> words;
  for (int w = 0; w < 12; ++w) words.push_back({0.35 * w, 0.35 * w + 0.33});
  for (auto _ : state) benchmark::DoNotOptimize(ContoursOfWords(f0.data(), f0.size(), 1, words));
}

#define GESTUS_RATES ->ArgName("rate")->Unit(benchmark::kMillisecond)->Arg(16000)->Arg(48000)

BENCHMARK_CAPTURE(Pitch, textbook, SwipeMode::kTextbook) GESTUS_RATES->Arg(8000)->Arg(44100);
BENCHMARK_CAPTURE(Pitch, sptk, SwipeMode::kSptk) GESTUS_RATES;
BENCHMARK(PitchLive) GESTUS_RATES;
BENCHMARK(Quality) GESTUS_RATES;
BENCHMARK(Setup) GESTUS_RATES;
BENCHMARK(Words)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gestus::prosody

BENCHMARK_MAIN();
