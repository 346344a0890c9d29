// A graph made ready to run: ops fused, weights packed, every intermediate given its place in one
// arena by its lifetime.  A plan is immutable and shared by any number of sessions.
#ifndef GESTUS_ENGINE_PLAN_H_
#define GESTUS_ENGINE_PLAN_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/graph.h"
#include "engine/status.h"
#include "engine/weight_cache.h"

namespace gestus {

struct PlanOptions {
  bool fuse = true;
  bool taps = false;  ///< keep every tapped value as an output "tap/<scope>/<name>"
  std::uint64_t max_arena_bytes = std::uint64_t{4} << 30;
};

/// Work of one op: floating-point operations and bytes of weights and values touched, once.
struct OpCost {
  double flops = 0, bytes = 0;
};

class Plan {
 public:
  /// One value's storage.
  struct Storage {
    std::uint64_t bytes = 0;
    std::uint64_t offset = 0;  ///< in the arena
    int first = 0, last = 0;   ///< first and last node that needs it
    bool in_arena = false;
  };
  /// One op with what the planner found out.
  struct Step {
    Node node;
    PackedPointer packed;
    std::uint64_t scratch_offset = 0;  ///< of state that all parts share, in the arena
    OpCost cost;
  };

  static Result<std::shared_ptr<const Plan>> Make(Graph graph, WeightCache& weights,
                                                  const PlanOptions& options = {});

  const kernels::KernelTable& kernels() const { return *kernels_; }
  const std::vector<Step>& steps() const { return steps_; }
  const std::vector<Loop>& loops() const { return loops_; }
  const std::vector<ValueInfo>& values() const { return values_; }
  const std::vector<Storage>& storage() const { return storage_; }
  const std::vector<NamedValue>& inputs() const { return inputs_; }
  const std::vector<NamedValue>& outputs() const { return outputs_; }
  /// The value that owns the storage of `id`.
  int Root(int id) const;

  std::uint64_t arena_bytes() const { return arena_bytes_; }
  /// What is needed at the step that needs most: no arena can be smaller.
  std::uint64_t live_bytes() const { return live_bytes_; }
  /// Scratch that each part needs beside the arena.
  std::uint64_t part_bytes() const { return part_bytes_; }
  /// Of one run.
  double flops() const;

  /// A table of the steps: op, shapes, place in the arena, work.
  std::string ToString() const;

 private:
  Plan() = default;
  void FindLifetimes();
  Status PlaceInArena(std::uint64_t max_bytes);

  const kernels::KernelTable* kernels_ = nullptr;
  std::shared_ptr<const WeightsFile> file_;  // biases and norms are read where they lie
  std::vector<Step> steps_;
  std::vector<Loop> loops_;
  std::vector<ValueInfo> values_;
  std::vector<Storage> storage_;  // by value id; meaningful for roots
  std::vector<NamedValue> inputs_, outputs_;
  std::vector<std::shared_ptr<AlignedBuffer>> owned_;
  std::uint64_t arena_bytes_ = 0, live_bytes_ = 0, part_bytes_ = 0;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_PLAN_H_
