// Runs a model in its steady state with every allocation, lock, mapping, write and throw of the
// process intercepted: there must be none.
//
//   steady_state WEIGHTS|every-op|every-op-bf16|every-op-int8|audio THREADS REPEATS [--plant]
//
// The runs lie between two getppid() calls, so that a tracer can tell the system calls among them.
// --plant allocates once in the middle, to show that the check can fail.
#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <new>
#include <vector>

#include "models/audio/fbank.h"
#include "models/audio/log_mel.h"
#include "models/audio/resampler.h"
#include "models/zs_mstm/zs_mstm.h"
#include "tests/engine/every_op.h"

namespace {

std::atomic<bool> armed{false};
std::atomic<long> caught{0};
std::atomic<const char*> first_caught{nullptr};
std::vector<float> planted;

void Note(const char* what) {
  if (!armed.load(std::memory_order_relaxed)) return;
  const char* none = nullptr;
  first_caught.compare_exchange_strong(none, what);
  caught.fetch_add(1);
}

template <class Function>
Function Next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// Visible to the shared libraries of the process, whose calls count as well.
#pragma GCC visibility push(default)
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t n) {
  Note("malloc");
  return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t m) {
  Note("calloc");
  return __libc_calloc(n, m);
}
void* realloc(void* p, std::size_t n) {
  Note("realloc");
  return __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t a, std::size_t n) {
  Note("aligned_alloc");
  return __libc_memalign(a, n);
}
void free(void* p) {
  Note("free");
  __libc_free(p);
}

int pthread_mutex_lock(pthread_mutex_t* m) noexcept {
  Note("pthread_mutex_lock");
  static const auto next = Next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  return next(m);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* m) noexcept {
  Note("pthread_rwlock_rdlock");
  static const auto next = Next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  return next(m);
}
int pthread_cond_wait(pthread_cond_t* c, pthread_mutex_t* m) {
  Note("pthread_cond_wait");
  static const auto next = Next<int (*)(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait");
  return next(c, m);
}
void* mmap(void* at, std::size_t n, int protection, int flags, int fd, off_t offset) noexcept {
  Note("mmap");
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, n, protection, flags, fd, offset));
}
int munmap(void* at, std::size_t n) noexcept {
  Note("munmap");
  return static_cast<int>(syscall(SYS_munmap, at, n));
}
ssize_t write(int fd, const void* data, std::size_t n) {
  Note("write");
  return syscall(SYS_write, fd, data, n);
}
[[noreturn]] void __cxa_throw(void* object, void* type, void (*destroy)(void*)) {
  Note("__cxa_throw");
  static const auto next = Next<void (*)(void*, void*, void (*)(void*))>("__cxa_throw");
  next(object, type, destroy);
  std::abort();
}

}  // extern "C"
#pragma GCC visibility pop

namespace {

using namespace gestus;  // NOLINT: this is a test of that library
using models::ZsMstm;

/// What is run again and again; empty after an error has been told.
using Subject = std::function<void()>;

Subject Fail(const Status& status) {
  std::fprintf(stderr, "%s\n", status.message().c_str());
  return {};
}

Subject ZsMstmOf(const char* path, int threads) {
  const auto file = WeightsFile::Open(path);
  if (!file.ok()) return Fail(file.status());
  const auto model = ZsMstm::Make(*file, "");
  if (!model.ok()) return Fail(model.status());
  auto made = ZsMstm::NewAgent(*model, {.threads = threads, .least_shared_flops = 0});
  if (!made.ok()) return Fail(made.status());
  const models::ZsMstmConfig& c = (*model)->config();
  const auto values = [&](std::int64_t cols) {
    return std::vector<float>(static_cast<std::size_t>(c.WindowFrames() * cols), 0.5f);
  };
  const std::shared_ptr<models::ZsMstmAgent> agent(std::move(*made));
  return [agent, speech = values(c.ast_content.mel_bins), text = values(c.d_text),
          pose = values(c.d_pose)]() mutable {
    agent->AddStyleSegment({speech.data(), text.data(), pose.data()});
    agent->Generate(speech.data(), text.data(), pose.data());
  };
}

Subject EveryOpOf(int threads, DType weights) {
  auto model = std::make_shared<test::Model>(test::MakeEveryOp(kernels::BestTable(), {}, weights));
  if (model->plan == nullptr) return {};
  auto made = Session::Create(model->plan, {.threads = threads, .least_shared_flops = 0});
  if (!made.ok()) return Fail(made.status());
  const std::shared_ptr<Session> session(std::move(*made));
  test::FillEveryOp(*session, 1);
  return [model, session] { session->Run(); };
}

// The stages of the audio front end, piece by piece and from recording to recording.
Subject Audio() {
  using namespace audio;  // NOLINT: as above
  struct Stages {
    Resampler resampler;
    LogMel log_mel;
    Fbank fbank;
    std::vector<float> samples, resampled, rows;
    int pieces = 0;
  };
  auto resampler = Resampler::Make(44100, 16000);
  auto log_mel = LogMel::Make(PatsLogMel512(44100));
  auto fbank = Fbank::Make();
  if (!resampler.ok() || !log_mel.ok() || !fbank.ok()) return Fail(resampler.status());
  auto s = std::make_shared<Stages>(
      Stages{*std::move(resampler), *std::move(log_mel), *std::move(fbank), {}, {}, {}});
  s->samples.assign(3000, 0.25f);
  s->resampled.resize(s->resampler.MaxRows(3000) + s->resampler.MaxRowsAtFinish());
  s->rows.resize(128 * (s->log_mel.MaxRows(3000) + s->fbank.MaxRows(s->resampled.size()) +
                        s->log_mel.MaxRowsAtFinish()));
  return [s] {
    const bool end = ++s->pieces % 10 == 0;
    s->log_mel.Push(s->samples.data(), s->samples.size(), s->rows.data());
    if (end) s->log_mel.Finish(s->rows.data());
    std::size_t n = s->resampler.Push(s->samples.data(), s->samples.size(), s->resampled.data());
    if (end) n += s->resampler.Finish(s->resampled.data() + n);
    s->fbank.Push(s->resampled.data(), n, s->rows.data());
    if (end) s->fbank.Finish(s->rows.data());
  };
}

Subject SubjectOf(const char* name, int threads) {
  if (std::strcmp(name, "every-op") == 0) return EveryOpOf(threads, DType::kF32);
  if (std::strcmp(name, "every-op-bf16") == 0) return EveryOpOf(threads, DType::kBF16);
  if (std::strcmp(name, "every-op-int8") == 0) return EveryOpOf(threads, DType::kI8);
  return std::strcmp(name, "audio") == 0 ? Audio() : ZsMstmOf(name, threads);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const int threads = std::atoi(argv[2]), repeats = std::atoi(argv[3]);
  const bool plant = argc > 4 && std::strcmp(argv[4], "--plant") == 0;
  const Subject run = SubjectOf(argv[1], threads);
  if (!run) return 2;

  for (int i = 0; i < 10; ++i) run();
  syscall(SYS_getppid);
  armed = true;
  for (int i = 0; i < repeats; ++i) {
    run();
    if (plant && i == repeats / 2) std::vector<float>(1).swap(planted);
  }
  armed = false;
  syscall(SYS_getppid);
  std::printf("%d runs, %d threads: %ld calls intercepted%s%s\n", repeats, threads, caught.load(),
              caught != 0 ? ", first " : "", caught != 0 ? first_caught.load() : "");
  return caught == 0 ? 0 : 1;
}
