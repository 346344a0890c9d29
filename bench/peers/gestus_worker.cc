// Keeps one network of bench/peers loaded and runs it on request, as workers.py asks:
//
//   gestus_worker FOLDER WEIGHTS.fb THREADS
//
// reads FOLDER/<input>.bin (raw little-endian values), runs once, says "ready", and then answers
// each line of standard input with one line:
//
//   run N        the nanoseconds of each of N runs
//   output PATH  "written": the outputs of the last run, one after the other, as raw values
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "bench/peers/networks.h"
#include "engine/plan.h"
#include "engine/session.h"
#include "models/io/file.h"
#include "models/io/reading.h"

namespace gestus::bench {
namespace {

constexpr std::uint64_t kMaxInput = std::uint64_t{64} << 20;

std::string InputPath(const std::string& folder, const std::string& name) {
  return folder + "/" + name + ".bin";
}

/// All values are of four bytes, float or int32.
std::int64_t ValuesOf(const std::string& folder, const std::string& name) {
  const Result<InputFile> file = OpenInput(InputPath(folder, name));
  return file.ok() ? static_cast<std::int64_t>(file->size / 4) : 0;
}

class Worker {
 public:
  Status Load(const std::string& folder, const std::string& weights, int threads);
  /// Nanoseconds of one run.
  std::int64_t Run();
  Status WriteOutputs(const std::string& path) const;

 private:
  std::unique_ptr<Session> session_;
  std::vector<std::string> outputs_;
};

Status Worker::Load(const std::string& folder, const std::string& weights, int threads) {
  auto file = WeightsFile::Open(weights);
  if (!file.ok()) return file.status();
  auto graph =
      DeclareNetwork(**file, [&](const std::string& name) { return ValuesOf(folder, name); });
  if (!graph.ok()) return graph.status();
  for (const NamedValue& output : graph->outputs()) outputs_.push_back(output.name);
  WeightCache cache(kernels::BestTable(), *file);
  auto plan = Plan::Make(*std::move(graph), cache);
  if (!plan.ok()) return plan.status();
  auto session = Session::Create(*plan, {.threads = threads});
  if (!session.ok()) return session.status();
  session_ = *std::move(session);
  for (const NamedValue& input : (*plan)->inputs()) {
    const auto bytes = ReadFile(InputPath(folder, input.name), kMaxInput);
    if (!bytes.ok()) return bytes.status();
    const ValueView to = session_->Input(input.name);
    if (static_cast<std::int64_t>(bytes->size()) != 4 * to.shape.NumElements())
      return Status(Code::kBadInput, InputPath(folder, input.name) + ": " +
                                         std::to_string(bytes->size()) +
                                         " bytes, expected values " + to.shape.ToString());
    std::memcpy(to.f32, bytes->data(), bytes->size());
  }
  return {};
}

std::int64_t Worker::Run() {
  const auto start = std::chrono::steady_clock::now();
  session_->Run();
  return std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
}

Status Worker::WriteOutputs(const std::string& path) const {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file.ok()) return file.status();
  for (const std::string& name : outputs_) {
    const ValueView out = session_->Output(name);
    const auto bytes = static_cast<std::size_t>(out.shape.Cols()) * sizeof(float);
    for (std::int64_t row = 0; row < out.shape.Rows(); ++row)
      GESTUS_RETURN_IF_ERROR(file->Write(out.f32 + row * out.row_stride, bytes));
  }
  return file->Commit();
}

bool ParseCount(const char* begin, const char* end, int* value) {
  const auto [at, error] = std::from_chars(begin, end, *value);
  return error == std::errc() && at == end && *value > 0;
}

Status Answer(Worker& worker, const std::string& request) {
  int count = 0;
  if (request.starts_with("run ") &&
      ParseCount(request.data() + 4, request.data() + request.size(), &count)) {
    std::vector<std::int64_t> times(static_cast<std::size_t>(count));
    for (std::int64_t& time : times) time = worker.Run();
    for (std::int64_t time : times) std::printf("%lld ", static_cast<long long>(time));
  } else if (request.starts_with("output ")) {
    GESTUS_RETURN_IF_ERROR(worker.WriteOutputs(request.substr(7)));
    std::printf("written");
  } else {
    return Status(Code::kInvalidArgument, "request: expected 'run N' or 'output PATH'");
  }
  std::printf("\n");
  std::fflush(stdout);
  return {};
}

Status Serve(const std::string& folder, const std::string& weights, int threads) {
  Worker worker;
  GESTUS_RETURN_IF_ERROR(worker.Load(folder, weights, threads));
  worker.Run();
  std::printf("ready\n");
  std::fflush(stdout);
  char line[4096];
  while (std::fgets(line, sizeof line, stdin) != nullptr)
    GESTUS_RETURN_IF_ERROR(Answer(worker, std::string(Trim(line))));
  return {};
}

}  // namespace
}  // namespace gestus::bench

int main(int argc, char** argv) {
  int threads = 0;
  if (argc != 4 || !gestus::bench::ParseCount(argv[3], argv[3] + std::strlen(argv[3]), &threads)) {
    std::fprintf(stderr, "usage: gestus_worker FOLDER WEIGHTS.fb THREADS\n");
    return 2;
  }
  const gestus::Status status = gestus::bench::Serve(argv[1], argv[2], threads);
  if (status.ok()) return 0;
  std::fprintf(stderr, "gestus_worker: %s\n", status.message().c_str());
  return 1;
}
