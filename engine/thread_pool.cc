// Parking, waking and meeting of the threads of a run.
#include "engine/thread_pool.h"

#include <memory>

namespace gestus {
namespace {

// Ops take microseconds, so a meeting is short; past this many polls the other thread was probably
// descheduled, and sleeping leaves it the processor.
constexpr int kPolls = 2000;

void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

template <class T>
void AwaitChange(const std::atomic<T>& value, T from) {
  for (int i = 0; i < kPolls; ++i) {
    if (value.load(std::memory_order_acquire) != from) return;
    Pause();
  }
  while (value.load(std::memory_order_acquire) == from) value.wait(from, std::memory_order_acquire);
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

void Barrier::Wait() {
  const std::uint32_t phase = phase_.load(std::memory_order_acquire);
  if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == count_) {
    waiting_.store(0, std::memory_order_relaxed);
    phase_.store(phase + 1, std::memory_order_release);
    phase_.notify_all();
    return;
  }
  AwaitChange(phase_, phase);
}

Worker::Range Worker::Part(std::size_t n, std::size_t grain) const {
  const std::size_t blocks = (n + grain - 1) / grain;
  const auto i = static_cast<std::size_t>(index), of = static_cast<std::size_t>(count);
  const std::size_t begin = blocks * i / of * grain;
  const std::size_t end = blocks * (i + 1) / of * grain;
  return {begin < n ? begin : n, end < n ? end : n};
}

struct ThreadPool::Start {
  ThreadPool* pool;
  int index;
};

ThreadPool::ThreadPool(int threads)
    : threads_(threads), fork_generation_(ForkGeneration()), barrier_(threads) {
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
    task(context, Worker{});
    return;
  }
  task_ = task;
  context_ = context;
  running_.store(threads_ - 1, std::memory_order_relaxed);
  epoch_.fetch_add(1, std::memory_order_release);
  epoch_.notify_all();
  task(context, Worker{0, threads_, &barrier_, 0});
  for (int left = running_.load(std::memory_order_acquire); left != 0;
       left = running_.load(std::memory_order_acquire)) {
    AwaitChange(running_, left);
  }
}

void ThreadPool::Work(int index) {
  std::uint32_t seen = 0;
  for (;;) {
    epoch_.wait(seen, std::memory_order_acquire);
    const std::uint32_t now = epoch_.load(std::memory_order_acquire);
    if (now == seen) continue;
    seen = now;
    if (stop_.load(std::memory_order_relaxed)) return;
    task_(context_, Worker{index, threads_, &barrier_, 0});
    if (running_.fetch_sub(1, std::memory_order_acq_rel) == 1) running_.notify_all();
  }
}

}  // namespace gestus
