// One start of a process that runs a network once, step by step, and the memory that it takes:
//
//   gestus_cold_start WEIGHTS.fb mapped|copied THREADS
//
// prints one line of JSON: the milliseconds of each step, the output's first value, and memory in
// MB after the run and at its peak.
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "bench/scale/first_run.h"
#include "engine/session.h"

namespace gestus::bench {
namespace {

double NowMs(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Prints the milliseconds since the step before: of time, and of this process' processors, which
/// says more where others run beside it.
class Steps {
 public:
  void Step(const char* name) {
    const double time = NowMs(CLOCK_MONOTONIC), cpu = NowMs(CLOCK_PROCESS_CPUTIME_ID);
    std::printf("\"%s_ms\": %.2f, \"%s_cpu_ms\": %.2f, ", name, time - time_, name, cpu - cpu_);
    time_ = NowMs(CLOCK_MONOTONIC);
    cpu_ = NowMs(CLOCK_PROCESS_CPUTIME_ID);
  }

 private:
  double time_ = NowMs(CLOCK_MONOTONIC), cpu_ = NowMs(CLOCK_PROCESS_CPUTIME_ID);
};

/// A field of /proc/self/status, in MB of 10^6 bytes.
double StatusMb(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(field + ":"))
      return std::strtod(line.c_str() + field.size() + 1, nullptr) * 1024e-6;
  }
  return 0;
}

Status Start(const std::string& path, Residence residence, int threads) {
  Steps steps;
  std::printf("{");
  auto file = WeightsFile::Open(path, {.residence = residence});
  if (!file.ok()) return file.status();
  steps.Step("open");
  FirstRun network;
  GESTUS_RETURN_IF_ERROR(network.Plan(*file));
  steps.Step("plan");
  GESTUS_RETURN_IF_ERROR(network.MakeSession(threads));
  steps.Step("session");
  network.Run();
  steps.Step("run");
  network.Run();
  steps.Step("second_run");
  std::printf("\"output\": %.9g, \"file_mb\": %.1f, \"resident_mb\": %.1f, \"peak_mb\": %.1f}\n",
              static_cast<double>(network.FirstValue()),
              static_cast<double>((*file)->file_size()) * 1e-6, StatusMb("VmRSS"),
              StatusMb("VmHWM"));
  return {};
}

}  // namespace
}  // namespace gestus::bench

int main(int argc, char** argv) {
  using gestus::Residence;
  const int threads = argc == 4 ? std::atoi(argv[3]) : 0;
  const bool mapped = argc == 4 && std::strcmp(argv[2], "mapped") == 0;
  if (threads < 1 || (!mapped && std::strcmp(argv[2], "copied") != 0)) {
    std::fprintf(stderr, "usage: gestus_cold_start WEIGHTS.fb mapped|copied THREADS\n");
    return 2;
  }
  const gestus::Status status =
      gestus::bench::Start(argv[1], mapped ? Residence::kMapped : Residence::kCopied, threads);
  if (status.ok()) return 0;
  std::fprintf(stderr, "gestus_cold_start: %s\n", status.message().c_str());
  return 1;
}
