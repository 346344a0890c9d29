// One agent's run of a plan: the arena, the bound ops, the threads.  Creating a session allocates
// everything; Run allocates nothing, takes no lock, throws nothing, and with one thread makes no
// system call.
//
//   auto session = Session::Create(plan, {.threads = 1});
//   std::memcpy((*session)->Input("speech"), mel, sizeof mel);
//   (*session)->Run();
//   use((*session)->Output("pose"));
//
// A session belongs to one thread at a time.  Sessions of one plan share its weights and nothing
// else.
#ifndef GESTUS_ENGINE_SESSION_H_
#define GESTUS_ENGINE_SESSION_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/status.h"
#include "engine/tensor.h"

namespace gestus {

class BoundOp;
class Plan;
class ThreadPool;

inline constexpr int kMaxThreads = 64;
/// FLOPs of a run that take about as long as waking another thread can, 0.4 ms.
inline constexpr double kLeastSharedFlops = 1e8;

struct SessionOptions {
  int threads = 1;                     ///< 1 to 64, the caller's among them
  std::shared_ptr<ThreadPool> pool{};  ///< of that many threads; null: the session makes its own
  bool profile = false;
  /// A plan of less work runs on the caller's thread alone.
  double least_shared_flops = kLeastSharedFlops;
};

/// What one op cost over all runs since the profile was last reset.
struct OpProfile {
  std::string name;  ///< "content/ast/block.0 linear"
  std::uint64_t runs = 0;
  double seconds = 0;
  double flops = 0, bytes = 0;  ///< of all runs
};

/// A value as a session holds it: rows x cols elements, `row_stride` apart.
struct ValueView {
  float* f32 = nullptr;
  std::int32_t* i32 = nullptr;  ///< the same place, for int32 values
  Shape shape;
  std::ptrdiff_t row_stride = 0;
};

class Session {
 public:
  static Result<std::unique_ptr<Session>> Create(std::shared_ptr<const Plan> plan,
                                                 const SessionOptions& options = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Where to write an input before a run; it keeps its content over runs.  The names are the
  /// graph's; an unknown name gives a view without data.
  ValueView Input(std::string_view name) const;
  /// Where an output lies after a run.
  ValueView Output(std::string_view name) const;

  void Run() noexcept;

  /// How many threads a run takes: fewer than were asked for where they would not pay.
  int threads() const;
  const Plan& plan() const { return *plan_; }
  std::uint64_t arena_bytes() const;
  /// Empty unless SessionOptions::profile was set.
  std::vector<OpProfile> Profile() const;
  void ResetProfile();

 private:
  struct Impl;
  explicit Session(std::shared_ptr<const Plan> plan);
  std::shared_ptr<const Plan> plan_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_SESSION_H_
