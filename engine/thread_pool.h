// The threads of a run.  Every thread walks the same list of phases (an op, or a step of an LSTM),
// and takes of each phase the parts that nobody has taken yet, its own first; a phase begins when
// all parts of the one before it are done.  So a worker that is still asleep holds up nobody: the
// others do its parts until it comes.  What a part computes follows from its index alone, whoever
// does it.
//
// Between runs the workers sleep in the kernel: nothing spins outside a run, and no OpenMP team of
// the host is used.
#ifndef GESTUS_ENGINE_THREAD_POOL_H_
#define GESTUS_ENGINE_THREAD_POOL_H_

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace gestus {

/// What an op knows of the part that it shall compute.
struct Part {
  int index = 0;
  int count = 1;
  std::int32_t step = 0;  ///< iteration of the enclosing loop
  std::size_t phase = 0;  ///< of the op's own

  /// This part of `n` items, a multiple of `grain` but for the last: [begin, end).
  struct Range {
    std::size_t begin, end;
    bool empty() const { return begin >= end; }
  };
  Range Of(std::size_t n, std::size_t grain = 1) const;
};

/// The parts of the phases of one run: which are taken, and how many are done.
class Phases {
 public:
  explicit Phases(int parts);

  int parts() const { return parts_; }
  /// Before a run, while nobody takes part.
  void Reset();
  /// Whether the caller is to do this part of a phase, of which the first is number 1: true once.
  bool Take(int part, std::uint64_t phase);
  void Done();
  /// Until all parts of `phase` are done.
  void Await(std::uint64_t phase);

 private:
  struct alignas(64) Taken {
    std::atomic<std::uint64_t> phase{0};  // the last in which this part was taken
  };
  const int parts_;
  std::unique_ptr<Taken[]> taken_;
  alignas(64) std::atomic<std::uint64_t> done_{0};  // parts of all phases
};

/// One thread on its way through the phases of a run; without Phases it is alone.
class Crew {
 public:
  Crew() = default;
  Crew(Phases* phases, int thread) : phases_(phases), thread_(thread) {}

  int thread() const { return thread_; }

  /// The next phase: calls do_part(index, count) for the parts that fall to this thread, and
  /// returns when all are done.
  template <class F>
  void Phase(const F& do_part) {
    if (phases_ == nullptr) return do_part(0, 1);
    ++phase_;
    const int count = phases_->parts();
    for (int n = 0; n < count; ++n) {
      const int index = (thread_ + n) % count;
      if (!phases_->Take(index, phase_)) continue;
      do_part(index, count);
      phases_->Done();
    }
    phases_->Await(phase_);
  }

 private:
  Phases* phases_ = nullptr;
  int thread_ = 0;
  std::uint64_t phase_ = 0;
};

class ThreadPool {
 public:
  using Task = void (*)(void* context, Crew crew);

  /// `threads` counts the caller of Run, so threads - 1 are started.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }
  /// False when the operating system gave fewer threads than asked for.
  bool complete() const { return complete_; }

  /// Calls task(context, crew) on the caller's thread, and on every other that is there before
  /// this one is through; returns when none is in it any more.  All must go through the same
  /// phases.  One caller at a time.  In a child made by fork(), where only the caller lives on, the
  /// caller does it all.
  void Run(Task task, void* context);

 private:
  struct Start;
  void Work(int index);
  bool Enter();
  void Leave();
  void KeepOffTheCallersProcessor() const;

  int threads_;
  bool complete_ = true;
  std::uint32_t fork_generation_;
  Phases phases_;
  std::atomic<std::uint32_t> epoch_{0};  // of runs
  std::atomic<std::uint32_t> inside_;    // workers in the run, and whether others may still enter
  std::atomic<std::uint32_t> started_{0};
  std::atomic<bool> stop_{false};
  Task task_ = nullptr;
  void* context_ = nullptr;
  pthread_t caller_{};
  int caller_processor_ = -1;
  std::vector<pthread_t> workers_;  // not std::thread, which a child made by fork() cannot drop
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_THREAD_POOL_H_
