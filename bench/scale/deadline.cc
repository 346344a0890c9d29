// A network that runs once every HOP milliseconds, as an agent's does:
//
//   gestus_deadline WEIGHTS.fb HOP_MS COUNT
//
// on one thread, in its default configuration, and prints the milliseconds from the moment that
// each of COUNT runs was due to its end.  Other programs may run beside it: that is what it is for.
#include <errno.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/scale/first_run.h"

namespace gestus::bench {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t Now() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNanoseconds + now.tv_nsec;
}

void SleepUntil(std::int64_t time) {
  const timespec until{time / kNanoseconds, time % kNanoseconds};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

Status Run(const std::string& path, std::int64_t hop, int count) {
  auto file = WeightsFile::Open(path, {.residence = Residence::kCopied});
  if (!file.ok()) return file.status();
  FirstRun network;
  GESTUS_RETURN_IF_ERROR(network.Plan(*file));
  GESTUS_RETURN_IF_ERROR(network.MakeSession(1));
  for (int i = 0; i < 10; ++i) network.Run();
  std::vector<std::int64_t> times(static_cast<std::size_t>(count));
  std::int64_t due = Now() + hop;
  for (std::int64_t& time : times) {
    SleepUntil(due);
    network.Run();
    time = Now() - due;
    due += hop;
  }
  for (const std::int64_t time : times) std::printf("%.4f ", static_cast<double>(time) * 1e-6);
  std::printf("\n");
  return {};
}

}  // namespace
}  // namespace gestus::bench

int main(int argc, char** argv) {
  const double hop = argc == 4 ? std::atof(argv[2]) : 0;
  const int count = argc == 4 ? std::atoi(argv[3]) : 0;
  if (!(hop > 0) || count < 1) {
    std::fprintf(stderr, "usage: gestus_deadline WEIGHTS.fb HOP_MS COUNT\n");
    return 2;
  }
  const gestus::Status status =
      gestus::bench::Run(argv[1], static_cast<std::int64_t>(hop * 1e6), count);
  if (status.ok()) return 0;
  std::fprintf(stderr, "gestus_deadline: %s\n", status.message().c_str());
  return 1;
}
