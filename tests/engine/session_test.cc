// Runs: the same bytes for any number of threads and sessions, the host's state untouched, nothing
// left behind.
#include "engine/session.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "engine/denormals.h"
#include "engine/thread_pool.h"
#include "tests/engine/every_op.h"
#include "tests/engine/isa_test.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace gestus::test {
namespace {

#if defined(__SANITIZE_THREAD__)
constexpr bool kThreadSanitizer = true;
#else
constexpr bool kThreadSanitizer = false;
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // everything takes many times as long
#else
constexpr bool kSanitized = false;
#endif
#ifdef GESTUS_EMULATED
constexpr bool kEmulated = true;  // by qemu-user, which keeps memory of threads that ended
#else
constexpr bool kEmulated = false;
#endif

// The model is small: by default it would never see another thread.
std::unique_ptr<Session> MakeSession(const Model& model, SessionOptions options = {}) {
  options.least_shared_flops = 0;
  auto session = Session::Create(model.plan, options);
  EXPECT_TRUE(session.ok()) << session.status().message();
  return session.ok() ? *std::move(session) : nullptr;
}

std::vector<float> RunOn(Session& session, std::uint32_t seed) {
  FillEveryOp(session, seed);
  session.Run();
  return AllOutputs(session);
}

::testing::AssertionResult SameBytes(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return ::testing::AssertionFailure() << "sizes differ";
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(float)) != 0)
      return ::testing::AssertionFailure() << "element " << i << ": " << a[i] << " and " << b[i];
  }
  return ::testing::AssertionSuccess();
}

class SessionTest : public IsaTest {};
GESTUS_TEST_ON_EVERY_ISA(SessionTest);

TEST_P(SessionTest, TheSameBytesForAnyNumberOfThreads) {
  const Model model = MakeEveryOp(*table_);
  const auto alone = MakeSession(model);
  for (const int threads : {1, 2, 3, 4, 8}) {
    const auto session = MakeSession(model, {.threads = threads});
    for (std::uint32_t run = 0; run < (kSanitized ? 2 : 5); ++run)
      ASSERT_TRUE(SameBytes(RunOn(*session, run), RunOn(*alone, run))) << threads << " threads";
  }
}

TEST_P(SessionTest, TheSameBytesForAnyNumberOfThreadsWithSmallWeights) {
  for (const DType dtype : {DType::kBF16, DType::kI8}) {
    const Model model = MakeEveryOp(*table_, {}, dtype);
    const auto alone = MakeSession(model);
    for (const int threads : {2, 3, 8}) {
      const auto session = MakeSession(model, {.threads = threads});
      for (std::uint32_t run = 0; run < 2; ++run)
        ASSERT_TRUE(SameBytes(RunOn(*session, run), RunOn(*alone, run)))
            << threads << " threads, " << Name(dtype);
    }
  }
}

// Rounded weights give nearly what the others give: bf16 keeps 8 bits, int8 7 of the largest.
TEST_P(SessionTest, SmallWeightsAreNearTheOthers) {
  const Model exact = MakeEveryOp(*table_);
  EXPECT_EQ(exact.plan->ToString().find("attention("), std::string::npos);
  const std::vector<float> want = RunOn(*MakeSession(exact), 3);
  for (const DType dtype : {DType::kBF16, DType::kI8}) {
    const Model model = MakeEveryOp(*table_, {}, dtype);
    const std::vector<float> got = RunOn(*MakeSession(model), 3);
    constexpr std::size_t kRowValues = 12 * 24;  // what follows depends on drawn tokens
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < kRowValues; ++i) {
      difference += std::pow(double{got[i]} - want[i], 2);
      size += std::pow(double{want[i]}, 2);
    }
    EXPECT_GT(difference, 0);
    EXPECT_LT(std::sqrt(difference / size), dtype == DType::kBF16 ? 0.02 : 0.05) << Name(dtype);
    const std::string plan = model.plan->ToString();
    EXPECT_NE(plan.find(std::string("linear(") + Name(dtype)), std::string::npos);
    // Between such products; what comes of a cache or a norm is attended to in float32.
    EXPECT_NE(plan.find("attention(bf16)"), std::string::npos);
    EXPECT_NE(plan.find("attention "), std::string::npos);
  }
}

TEST_P(SessionTest, TheSameBytesInEveryRunAndWithAProfile) {
  const Model model = MakeEveryOp(*table_);
  const auto plain = MakeSession(model), profiled = MakeSession(model, {.profile = true});
  const std::vector<float> first = RunOn(*plain, 1);
  RunOn(*plain, 2);
  EXPECT_TRUE(SameBytes(RunOn(*plain, 1), first));
  EXPECT_TRUE(SameBytes(RunOn(*profiled, 1), first));
}

TEST_P(SessionTest, InputsKeepTheirContentOverRuns) {
  const Model model = MakeEveryOp(*table_);
  const auto session = MakeSession(model);
  const std::vector<float> first = RunOn(*session, 1);
  for (int i = 0; i < 3; ++i) session->Run();
  EXPECT_TRUE(SameBytes(AllOutputs(*session), first));
}

TEST(SessionsTest, NanInOneReachesNoOtherAndDoesNotStay) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto sick = MakeSession(model), sound = MakeSession(model), solo = MakeSession(model);
  for (std::uint32_t run = 0; run < 10; ++run) {
    FillEveryOp(*sick, run);
    sick->Input("x").f32[run * 7] = run % 2 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                 : std::numeric_limits<float>::infinity();
    sick->Run();
    ASSERT_TRUE(SameBytes(RunOn(*sound, run), RunOn(*solo, run)));
    // No state outlives a run: the next one on finite input is as of a fresh session.
    ASSERT_TRUE(SameBytes(RunOn(*sick, run), RunOn(*solo, run)));
  }
}

TEST(SessionsTest, ManyInParallelAgreeWithOneAlone) {
  const Model model = MakeEveryOp(kernels::BestTable());
  constexpr int kHosts = 6, kRuns = kSanitized ? 8 : 30;
  std::vector<std::vector<float>> want;
  const auto solo = MakeSession(model);
  for (std::uint32_t seed = 0; seed < kRuns; ++seed) want.push_back(RunOn(*solo, seed));
  std::atomic<int> wrong{0};
  std::vector<std::thread> hosts;
  for (int h = 0; h < kHosts; ++h) {
    hosts.emplace_back([&, h] {
      for (std::uint32_t seed = 0; seed < kRuns; ++seed) {
        // Some sessions are kept for long, some are made and destroyed while others run.
        const auto session = MakeSession(model, {.threads = 1 + (h + static_cast<int>(seed)) % 3});
        for (int i = 0; i < 2; ++i) {
          if (!SameBytes(RunOn(*session, seed), want[seed])) ++wrong;
        }
      }
    });
  }
  for (std::thread& host : hosts) host.join();
  EXPECT_EQ(wrong.load(), 0);
}

TEST(SessionsTest, SharedPoolServesSeveralSessions) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto pool = std::make_shared<ThreadPool>(3);
  const auto a = MakeSession(model, {.threads = 3, .pool = pool});
  const auto b = MakeSession(model, {.threads = 3, .pool = pool});
  const auto solo = MakeSession(model);
  for (std::uint32_t run = 0; run < 20; ++run) {
    EXPECT_TRUE(SameBytes(RunOn(*a, run), RunOn(*solo, run)));
    EXPECT_TRUE(SameBytes(RunOn(*b, run + 1), RunOn(*solo, run + 1)));
  }
}

TEST(SessionsTest, SmallPlansRunAlone) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const double flops = model.plan->flops();
  EXPECT_GT(flops, 0);
  const struct {
    double least;
    int threads;
  } cases[] = {{kLeastSharedFlops, 1}, {flops * 1.01, 1}, {flops * 0.99, 3}, {0, 3}};
  for (const auto& c : cases) {
    const auto session = Session::Create(model.plan, {.threads = 3, .least_shared_flops = c.least});
    ASSERT_TRUE(session.ok());
    EXPECT_EQ((*session)->threads(), c.threads) << c.least;
  }
}

TEST(SessionsTest, OptionsOutOfRangeAreRefused) {
  const Model model = MakeEveryOp(kernels::BestTable());
  for (const int threads : {-1, 0, kMaxThreads + 1}) {
    const auto session = Session::Create(model.plan, {.threads = threads});
    ASSERT_FALSE(session.ok());
    EXPECT_EQ(session.status().message(),
              "threads: " + std::to_string(threads) + ", expected 1 to 64");
  }
  const auto small = std::make_shared<ThreadPool>(2);
  EXPECT_FALSE(Session::Create(model.plan, {.threads = 3, .pool = small}).ok());
}

TEST(SessionsTest, UnknownNamesGiveNoData) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto session = MakeSession(model);
  EXPECT_EQ(session->Input("rows").f32, nullptr);
  EXPECT_EQ(session->Output("x").f32, nullptr);
  EXPECT_EQ(session->Output("").f32, nullptr);
  EXPECT_NE(session->Output("rows").f32, nullptr);
}

TEST(SessionsTest, ProfileAddsUp) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto session = MakeSession(model, {.threads = 2, .profile = true});
  constexpr int kRuns = 5;
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint32_t i = 0; i < kRuns; ++i) RunOn(*session, i);
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::vector<OpProfile> profile = session->Profile();
  ASSERT_EQ(profile.size(), model.plan->steps().size());
  double seconds = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Plan::Step& step = model.plan->steps()[i];
    const std::uint64_t times = step.node.loop >= 0 ? 6 * kRuns : kRuns;
    EXPECT_EQ(profile[i].runs, times) << profile[i].name;
    EXPECT_DOUBLE_EQ(profile[i].flops, step.cost.flops * static_cast<double>(times));
    EXPECT_EQ(profile[i].name, step.node.scope + " " + Name(step.node.op));
    seconds += profile[i].seconds;
  }
  EXPECT_GT(seconds, 0);
  EXPECT_LE(seconds, wall);
  session->ResetProfile();
  EXPECT_EQ(session->Profile()[0].runs, 0u);
  const auto plain = MakeSession(model);
  plain->ResetProfile();
  EXPECT_TRUE(plain->Profile().empty());
}

#if defined(__SSE2__)
constexpr unsigned kFlushBits = 0x8040;

TEST(HostStateTest, TheFloatingPointModeIsRestored) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto session = MakeSession(model, {.threads = 2});
  const std::vector<float> want = RunOn(*session, 1);
  const unsigned before = _mm_getcsr();
  // Rounding upwards, or traps for every exception: the host's choice, and the results' no matter.
  for (const unsigned mode : {before, (before & ~0x6000u) | 0x4000u, before & ~0x1f80u}) {
    FillEveryOp(*session, 1);
    _mm_setcsr(mode & ~0x3fu);
    session->Run();
    const unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    EXPECT_EQ(after, mode & ~0x3fu);
    EXPECT_TRUE(SameBytes(AllOutputs(*session), want));
  }
}

TEST(HostStateTest, DenormalsAreFlushedInEveryThread) {
  // A value that decays below the smallest normal number must become zero, whoever computes it.
  Tensors tensors;
  Graph g;
  const Value x = g.Input("x", {64, 32});
  g.Output("y", g.Affine(x, std::vector<float>(32, 1e-3f), std::vector<float>(32, 0.0f)));
  WeightCache cache(kernels::BestTable(), nullptr);
  auto plan = Plan::Make(std::move(g), cache);
  ASSERT_TRUE(plan.ok());
  for (const int threads : {1, 4}) {
    auto session = Session::Create(*plan, {.threads = threads, .least_shared_flops = 0});
    ASSERT_TRUE(session.ok());
    const ValueView in = (*session)->Input("x"), out = (*session)->Output("y");
    std::fill(in.f32, in.f32 + 64 * 32, 2e-38f);
    std::fill(out.f32, out.f32 + 64 * 32, 1.0f);
    (*session)->Run();
    for (int i = 0; i < 64 * 32; ++i) ASSERT_EQ(out.f32[i], 0.0f) << "row " << i / 32;
  }
  EXPECT_EQ(_mm_getcsr() & kFlushBits, 0u);
  const FlushDenormals flush;
  EXPECT_EQ(_mm_getcsr() & kFlushBits, kFlushBits);
}
#endif

TEST(HostStateTest, NoOpenMpIsLoaded) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    EXPECT_EQ(line.find("libgomp"), std::string::npos) << line;
    EXPECT_EQ(line.find("libomp"), std::string::npos) << line;
  }
}

std::size_t Threads() {
  std::size_t n = 0;
  for ([[maybe_unused]] const auto& t : std::filesystem::directory_iterator("/proc/self/task")) ++n;
  return n;
}

double ResidentMiB() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  statm >> size >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

TEST(HostStateTest, AThousandSessionsLeaveNothingBehind) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto cycle = [&](int i) {
    const auto session = MakeSession(model, {.threads = 1 + i % 3});
    if (i % 10 < 3) session->Run();
  };
  for (int i = 0; i < 100; ++i) cycle(i);
  const std::size_t threads = Threads();
  const double resident = ResidentMiB();
  for (int i = 0; i < (kSanitized || kEmulated ? 100 : 1000); ++i) cycle(i);
  // A joined thread may take a moment to leave the list, those before the count too.
  for (int i = 0; i < 200 && Threads() > threads; ++i) usleep(1000);
  EXPECT_LE(Threads(), threads);
  // Sanitizers keep what is freed.
  if (!kSanitized && !kEmulated) {
    EXPECT_LE(ResidentMiB() - resident, 1.0);
  }
}

TEST(HostStateTest, WorkersSleepBetweenRuns) {
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto session = MakeSession(model, {.threads = 4});
  RunOn(*session, 1);
  usleep(20000);
  const std::clock_t before = std::clock();  // processor time of all threads
  usleep(200000);
  const double used = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  EXPECT_LT(used, 0.02) << "seconds of processor time in 0.2 s of rest";
}

/// Runs `child` in a forked process and returns its exit status, or -1 when it takes 2 seconds.
int ExitOfChild(const std::function<bool()>& child) {
  const pid_t pid = fork();
  if (pid == 0) _exit(child() ? 0 : 1);
  for (int i = 0; i < 2000; ++i) {
    int status = 0;
    if (waitpid(pid, &status, WNOHANG) == pid)
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    usleep(1000);
  }
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  return -1;
}

TEST(ForkTest, AChildRunsAndGivesTheSameBytes) {
  if (kThreadSanitizer) GTEST_SKIP() << "the thread sanitizer forbids threads after fork";
  const Model model = MakeEveryOp(kernels::BestTable());
  const auto session = MakeSession(model, {.threads = 3});
  const std::vector<float> want = RunOn(*session, 1);
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(ExitOfChild([&] { return bool{SameBytes(RunOn(*session, 1), want)}; }), 0);
    ASSERT_TRUE(SameBytes(RunOn(*session, 1), want)) << "in the parent, after fork " << i;
  }
}

TEST(ForkTest, AChildMayMakeAndDestroySessions) {
  if (kThreadSanitizer) GTEST_SKIP() << "the thread sanitizer forbids threads after fork";
  if (kEmulated) GTEST_SKIP() << "qemu-user 7.2 aborts when a forked child makes threads";
  const Model model = MakeEveryOp(kernels::BestTable());
  auto inherited = MakeSession(model, {.threads = 8});
  const std::vector<float> want = RunOn(*inherited, 1);
  EXPECT_EQ(ExitOfChild([&] {
              // The new threads may get the handles that the old ones had.
              auto own = MakeSession(model, {.threads = 8});
              bool good{SameBytes(RunOn(*own, 1), want)};
              inherited.reset();
              good = good && SameBytes(RunOn(*own, 1), want);
              own.reset();
              return good;
            }),
            0);
  EXPECT_TRUE(SameBytes(RunOn(*inherited, 1), want));
}

TEST(PartTest, PartsCoverEverythingOnce) {
  for (const std::size_t n : {0u, 1u, 7u, 64u, 1000u}) {
    for (const std::size_t grain : {1u, 8u, 48u}) {
      for (int count = 1; count <= 9; ++count) {
        std::size_t at = 0;
        for (int i = 0; i < count; ++i) {
          const Part::Range part = Part{i, count}.Of(n, grain);
          ASSERT_EQ(part.begin, at);
          ASSERT_TRUE(part.begin % grain == 0 || part.empty());
          ASSERT_GE(part.end, part.begin);
          at = part.end;
        }
        ASSERT_EQ(at, n);
      }
    }
  }
}

/// What became of the parts of some phases.
struct Tally {
  static constexpr int kParts = 4, kPhases = 50;
  std::atomic<int> runs[kPhases][kParts] = {};
  std::atomic<int> done{0};
  std::atomic<bool> early{false}, over{false};
  int thread_that_stays_away = -1;

  static void Go(void* context, Crew crew) {
    auto& tally = *static_cast<Tally*>(context);
    while (crew.thread() == tally.thread_that_stays_away && !tally.over) std::this_thread::yield();
    for (int phase = 0; phase < kPhases; ++phase) {
      crew.Phase([&](int index, int count) {
        if (count != kParts || tally.done < phase * kParts) tally.early = true;
        ++tally.runs[phase][index];
        ++tally.done;
      });
    }
    tally.over = true;
  }
  void ExpectEachOnce() const {
    EXPECT_FALSE(early) << "a part began before the phase before it was done";
    for (const auto& phase : runs) {
      for (const auto& part : phase) ASSERT_EQ(part.load(), 1);
    }
  }
};

TEST(ThreadPoolTest, EveryPartIsDoneOnceInEachOfManyRuns) {
  ThreadPool pool(Tally::kParts);
  ASSERT_TRUE(pool.complete());
  for (int run = 0; run < 200; ++run) {
    Tally tally;
    pool.Run(Tally::Go, &tally);
    tally.ExpectEachOnce();
  }
}

TEST(ThreadPoolTest, WorkersStayOnTheCallersProcessors) {
  cpu_set_t before, allowed;
  ASSERT_EQ(pthread_getaffinity_np(pthread_self(), sizeof before, &before), 0);
  CPU_ZERO(&allowed);
  CPU_SET(sched_getcpu(), &allowed);  // one, which all of them share
  ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof allowed, &allowed), 0);
  ThreadPool pool(Tally::kParts);
  for (int run = 0; run < 20; ++run) {
    Tally tally;
    pool.Run(Tally::Go, &tally);
    tally.ExpectEachOnce();
  }
  // Now there are others to go to, and no more than the caller has.
  ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof before, &before), 0);
  struct Where {
    cpu_set_t allowed;
    std::atomic<bool> astray{false};
  } where{before};
  for (int run = 0; run < 200; ++run) {
    pool.Run(
        [](void* context, Crew crew) {
          auto& w = *static_cast<Where*>(context);
          crew.Phase([&](int, int) {
            if (!CPU_ISSET(sched_getcpu(), &w.allowed)) w.astray = true;
          });
        },
        &where);
  }
  EXPECT_FALSE(where.astray);
}

TEST(ThreadPoolTest, NobodyWaitsForAWorkerThatStaysAway) {
  ThreadPool pool(Tally::kParts);
  ASSERT_TRUE(pool.complete());
  for (int run = 0; run < 20; ++run) {
    Tally tally;
    tally.thread_that_stays_away = 1 + run % 3;
    pool.Run(Tally::Go, &tally);
    tally.ExpectEachOnce();
  }
}

}  // namespace
}  // namespace gestus::test
