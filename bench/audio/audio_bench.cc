// The audio front end for one segment of 64 frames, 4.27 s of speech: reading WAV, resampling,
// log-mel, AST's filter bank, and the chains that a network is fed by.  Counter x_real_time:
// seconds of sound for a second of work.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "models/audio/fbank.h"
#include "models/audio/log_mel.h"
#include "models/audio/resampler.h"
#include "models/audio/source.h"

namespace gestus::audio {
namespace {

constexpr double kSegment = 64.0 / 15;  // seconds

std::vector<float> Sound(int rate) {
  std::vector<float> samples(static_cast<std::size_t>(kSegment * rate));
  std::uint32_t noise = 1;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    noise = noise * 1664525u + 1013904223u;
    const double t = static_cast<double>(i) / rate;
    samples[i] = static_cast<float>(0.3 * std::sin(900 * t + 40 * std::sin(5 * t))) +
                 static_cast<float>(noise >> 8) * 0x1p-30f;
  }
  return samples;
}

void SetRate(benchmark::State& state) {
  state.counters["x_real_time"] =
      benchmark::Counter(kSegment, benchmark::Counter::kIsIterationInvariantRate);
}

// A stage fed in pieces of 10 ms, as by a microphone.
template <class T>
void Stream(benchmark::State& state, Result<T> made, int rate) {
  if (!made.ok()) return state.SkipWithError(made.status().message().c_str());
  T& stage = *made;
  const std::vector<float> samples = Sound(rate);
  const std::size_t piece = static_cast<std::size_t>(rate) / 100;
  const auto width = static_cast<std::size_t>(stage.width());
  std::vector<float> rows(width * std::max(stage.MaxRows(piece), stage.MaxRowsAtFinish()));
  for (auto _ : state) {
    for (std::size_t at = 0; at < samples.size(); at += piece) {
      stage.Push(&samples[at], std::min(piece, samples.size() - at), rows.data());
      benchmark::DoNotOptimize(rows.data());
    }
    stage.Finish(rows.data());
    benchmark::ClobberMemory();
  }
  SetRate(state);
}

void LogMel512(benchmark::State& state) {
  const int rate = static_cast<int>(state.range(0));
  Stream(state, LogMel::Make(PatsLogMel512(rate)), rate);
}
BENCHMARK(LogMel512)->Arg(16000)->Arg(44100)->Arg(48000)->Arg(96000)->Unit(benchmark::kMillisecond);

void LogMel400(benchmark::State& state) { Stream(state, LogMel::Make(PatsLogMel400()), 16000); }
BENCHMARK(LogMel400)->Unit(benchmark::kMillisecond);

void FilterBank(benchmark::State& state) { Stream(state, Fbank::Make(), 16000); }
BENCHMARK(FilterBank)->Unit(benchmark::kMillisecond);

void Resample(benchmark::State& state) {
  const int from = static_cast<int>(state.range(0)), to = static_cast<int>(state.range(1));
  Stream(state, Resampler::Make(from, to), from);
}
BENCHMARK(Resample)
    ->Args({44100, 16000})
    ->Args({48000, 16000})
    ->Args({96000, 16000})
    ->Args({16000, 44100})
    ->Args({44100, 48001})
    ->Unit(benchmark::kMillisecond);

// A WAV file of 16 bits in the folder for temporary files; no path when it cannot be written.
class WavFile {
 public:
  WavFile(int rate, int channels) {
    const char* folder = std::getenv("TMPDIR");
    path_ = std::string(folder != nullptr ? folder : "/tmp") + "/gestus_bench_" +
            std::to_string(::getpid()) + ".wav";
    const auto frames = static_cast<std::uint32_t>(kSegment * rate);
    std::vector<std::uint8_t> bytes;
    const auto put = [&](std::uint32_t value, int n) {
      for (int i = 0; i < n; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    const auto text = [&](const char* word) { bytes.insert(bytes.end(), word, word + 4); };
    const auto block = static_cast<std::uint32_t>(2 * channels);
    text("RIFF"), put(36 + frames * block, 4), text("WAVE"), text("fmt "), put(16, 4), put(1, 2);
    put(block / 2, 2), put(static_cast<std::uint32_t>(rate), 4);
    put(static_cast<std::uint32_t>(rate) * block, 4), put(block, 2), put(16, 2);
    text("data"), put(frames * block, 4);
    for (std::uint32_t i = 0; i < frames * block; ++i)
      bytes.push_back(static_cast<std::uint8_t>(i));
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    const bool ok =
        file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (file == nullptr || std::fclose(file) != 0 || !ok) path_.clear();
  }
  ~WavFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// From a file in the system's cache to rows, 100 ms at a time; `rate` 0 leaves out the stages.
template <class T>
void ReadAnd(benchmark::State& state, int channels, int rate, Result<T> made) {
  const WavFile file(44100, channels);
  if (!made.ok() || file.path().empty()) return state.SkipWithError("no file or no stage");
  Result<Resampler> resampler = Resampler::Make(44100, rate == 0 ? 44100 : rate);
  std::vector<float> piece(4410), resampled(resampler->MaxRows(4410));
  const auto width = static_cast<std::size_t>(made->width());
  std::vector<float> rows(width * made->MaxRows(resampled.size()));
  for (auto _ : state) {
    auto source = OpenAudio(file.path());
    if (!source.ok()) return state.SkipWithError(source.status().message().c_str());
    for (;;) {
      const Result<std::size_t> got = (*source)->Read(piece.data(), piece.size());
      if (!got.ok() || *got == 0) break;
      benchmark::DoNotOptimize(piece.data());
      if (rate == 0) continue;
      const std::size_t n = resampler->Push(piece.data(), *got, resampled.data());
      made->Push(resampled.data(), n, rows.data());
      benchmark::ClobberMemory();
    }
  }
  SetRate(state);
}

void ReadWav(benchmark::State& state) {
  ReadAnd(state, static_cast<int>(state.range(0)), 0, Fbank::Make());
}
BENCHMARK(ReadWav)->Arg(1)->Arg(2)->Arg(6)->Unit(benchmark::kMillisecond);

void WavToLogMel512(benchmark::State& state) {
  ReadAnd(state, 2, 44100, LogMel::Make(PatsLogMel512(44100)));
}
BENCHMARK(WavToLogMel512)->Unit(benchmark::kMillisecond);

void WavToFilterBank(benchmark::State& state) { ReadAnd(state, 2, 16000, Fbank::Make()); }
BENCHMARK(WavToFilterBank)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gestus::audio
