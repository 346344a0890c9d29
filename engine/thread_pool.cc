// Parking, waking and sharing out of the threads of a run.
#include "engine/thread_pool.h"

#include <sched.h>

namespace gestus {
namespace {

// Ops take microseconds, so others are soon done; past this many polls another thread was probably
// descheduled, and sleeping leaves it the processor.
constexpr int kPolls = 2000;

constexpr std::uint32_t kClosed = 1u << 31;  // of ThreadPool::inside_

void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Until `good` of the value; returns at once when it is already.
template <class T, class Good>
void AwaitValue(const std::atomic<T>& value, const Good& good) {
  for (int i = 0; i < kPolls; ++i) {
    if (good(value.load(std::memory_order_acquire))) return;
    Pause();
  }
  for (;;) {
    const T found = value.load(std::memory_order_acquire);
    if (good(found)) return;
    value.wait(found, std::memory_order_acquire);
  }
}

// Counts forks this process is the child of: threads do not survive one.
std::atomic<std::uint32_t> fork_generation{0};

std::uint32_t ForkGeneration() {
  static const int registered = pthread_atfork(
      nullptr, nullptr, [] { fork_generation.fetch_add(1, std::memory_order_relaxed); });
  (void)registered;
  return fork_generation.load(std::memory_order_relaxed);
}

}  // namespace

Part::Range Part::Of(std::size_t n, std::size_t grain) const {
  const std::size_t blocks = (n + grain - 1) / grain;
  const auto i = static_cast<std::size_t>(index), of = static_cast<std::size_t>(count);
  const std::size_t begin = blocks * i / of * grain;
  const std::size_t end = blocks * (i + 1) / of * grain;
  return {begin < n ? begin : n, end < n ? end : n};
}

Phases::Phases(int parts)
    : parts_(parts), taken_(std::make_unique<Taken[]>(static_cast<std::size_t>(parts))) {}

void Phases::Reset() {
  for (int i = 0; i < parts_; ++i) taken_[static_cast<std::size_t>(i)].phase.store(0);
  done_.store(0);
}

bool Phases::Take(int part, std::uint64_t phase) {
  std::atomic<std::uint64_t>& taken = taken_[static_cast<std::size_t>(part)].phase;
  // Every part is taken in every phase, so while it is free in this one it holds the one before.
  std::uint64_t before = phase - 1;
  if (taken.load(std::memory_order_relaxed) != before) return false;
  return taken.compare_exchange_strong(before, phase, std::memory_order_acq_rel);
}

void Phases::Done() {
  done_.fetch_add(1, std::memory_order_acq_rel);
  done_.notify_all();
}

void Phases::Await(std::uint64_t phase) {
  const std::uint64_t all = phase * static_cast<std::uint64_t>(parts_);
  AwaitValue(done_, [all](std::uint64_t done) { return done >= all; });
}

struct ThreadPool::Start {
  ThreadPool* pool;
  int index;
};

ThreadPool::ThreadPool(int threads)
    : threads_(threads), fork_generation_(ForkGeneration()), phases_(threads), inside_(kClosed) {
  workers_.reserve(static_cast<std::size_t>(threads - 1));
  const auto enter = [](void* p) -> void* {
    const std::unique_ptr<Start> start(static_cast<Start*>(p));
    start->pool->Work(start->index);
    return nullptr;
  };
  for (int i = 1; i < threads; ++i) {
    auto start = std::make_unique<Start>(Start{this, i});
    pthread_t thread;
    complete_ = pthread_create(&thread, nullptr, enter, start.get()) == 0;
    if (!complete_) return;
    start.release();  // the thread owns it now
    workers_.push_back(thread);
  }
  // What a thread does once is over before the first run.
  AwaitValue(started_, [&](std::uint32_t started) { return started == workers_.size(); });
}

ThreadPool::~ThreadPool() {
  // In a child the handles mean nothing: the threads stayed in the parent.
  if (fork_generation_ != ForkGeneration()) return;
  stop_.store(true, std::memory_order_relaxed);
  epoch_.fetch_add(1, std::memory_order_release);
  epoch_.notify_all();
  for (pthread_t w : workers_) pthread_join(w, nullptr);
}

void ThreadPool::Run(Task task, void* context) {
  if (fork_generation_ != fork_generation.load(std::memory_order_relaxed)) {
    task(context, Crew{});
    return;
  }
  task_ = task;
  context_ = context;
  caller_ = pthread_self();
  caller_processor_ = sched_getcpu();
  phases_.Reset();
  inside_.store(0, std::memory_order_release);
  epoch_.fetch_add(1, std::memory_order_release);
  epoch_.notify_all();
  task(context, Crew(&phases_, 0));
  inside_.fetch_or(kClosed, std::memory_order_acq_rel);
  AwaitValue(inside_, [](std::uint32_t inside) { return inside == kClosed; });
}

bool ThreadPool::Enter() {
  std::uint32_t inside = inside_.load(std::memory_order_relaxed);
  do {
    if ((inside & kClosed) != 0) return false;
  } while (!inside_.compare_exchange_weak(inside, inside + 1, std::memory_order_acq_rel));
  return true;
}

void ThreadPool::Leave() {
  if (inside_.fetch_sub(1, std::memory_order_acq_rel) - 1 == kClosed) inside_.notify_all();
}

// In a virtual machine a processor that sleeps looks to Linux like one that is not to be had, so it
// wakes threads on the processor of who wakes them, and leaves them there for milliseconds.
void ThreadPool::KeepOffTheCallersProcessor() const {
  if (caller_processor_ < 0 || sched_getcpu() != caller_processor_) return;
  cpu_set_t others;
  if (pthread_getaffinity_np(caller_, sizeof others, &others) != 0) return;
  CPU_CLR(caller_processor_, &others);
  if (CPU_COUNT(&others) > 0) pthread_setaffinity_np(pthread_self(), sizeof others, &others);
}

void ThreadPool::Work(int index) {
  started_.fetch_add(1, std::memory_order_acq_rel);
  started_.notify_all();
  std::uint32_t seen = 0;
  for (;;) {
    epoch_.wait(seen, std::memory_order_acquire);
    seen = epoch_.load(std::memory_order_acquire);
    if (stop_.load(std::memory_order_relaxed)) return;
    if (!Enter()) continue;  // too late
    KeepOffTheCallersProcessor();
    task_(context_, Crew(&phases_, index));
    Leave();
  }
}

}  // namespace gestus
