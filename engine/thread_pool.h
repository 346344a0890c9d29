// The threads of a run.  Every thread walks the same list of ops and meets the others at a barrier
// after each; which part of an op a thread computes follows from its index alone.  Between runs the
// workers sleep in the kernel: nothing spins outside a run, and no OpenMP team of the host is used.
#ifndef GESTUS_ENGINE_THREAD_POOL_H_
#define GESTUS_ENGINE_THREAD_POOL_H_

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gestus {

/// Meeting point of a fixed number of threads.
class Barrier {
 public:
  explicit Barrier(int count) : count_(count), waiting_(0) {}
  void Wait();

 private:
  const int count_;
  std::atomic<int> waiting_;
  std::atomic<std::uint32_t> phase_{0};
};

/// What an op knows of the thread that runs it.
struct Worker {
  int index = 0;
  int count = 1;
  Barrier* barrier = nullptr;  ///< null when count == 1
  std::int32_t step = 0;       ///< iteration of the enclosing loop

  void Meet() const {
    if (barrier != nullptr) barrier->Wait();
  }
  /// This worker's part of `n` items, a multiple of `grain` but for the last: [begin, end).
  struct Range {
    std::size_t begin, end;
    bool empty() const { return begin >= end; }
  };
  Range Part(std::size_t n, std::size_t grain = 1) const;
};

class ThreadPool {
 public:
  using Task = void (*)(void* context, Worker worker);

  /// `threads` counts the caller of Run, so threads - 1 are started.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }
  /// False when the operating system gave fewer threads than asked for.
  bool complete() const { return complete_; }

  /// Calls task(context, worker) on every thread and returns when all are done.  One caller at a
  /// time.  In a child made by fork(), where only the caller lives on, the caller does it all.
  void Run(Task task, void* context);

 private:
  struct Start;
  void Work(int index);
  int threads_;
  bool complete_ = true;
  std::uint32_t fork_generation_;
  Barrier barrier_;
  std::atomic<std::uint32_t> epoch_{0};
  std::atomic<int> running_{0};
  std::atomic<bool> stop_{false};
  Task task_ = nullptr;
  void* context_ = nullptr;
  std::vector<pthread_t> workers_;  // not std::thread, which a child made by fork() cannot drop
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_THREAD_POOL_H_
