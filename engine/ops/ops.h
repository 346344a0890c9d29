// What the planner and the session ask of an op: does it pack weights, how much scratch, how much
// work, and a version of it that is bound to pointers and ready to run.
#ifndef GESTUS_ENGINE_OPS_OPS_H_
#define GESTUS_ENGINE_OPS_OPS_H_

#include <memory>
#include <vector>

#include "engine/graph.h"
#include "engine/plan.h"
#include "engine/thread_pool.h"

namespace gestus {

/// A value in memory: `batch` matrices of rows x cols.
struct Ref {
  float* f32 = nullptr;
  std::size_t batch = 1, rows = 0, cols = 0;
  std::ptrdiff_t row_stride = 0, batch_stride = 0;

  const std::int32_t* i32() const { return reinterpret_cast<const std::int32_t*>(f32); }
  float* at(std::size_t b, std::size_t row) const {
    return f32 + static_cast<std::ptrdiff_t>(b) * batch_stride +
           static_cast<std::ptrdiff_t>(row) * row_stride;
  }
  /// True when all rows of all matrices lie at one distance, so that they are one tall matrix.
  bool tall() const {
    return batch == 1 || batch_stride == static_cast<std::ptrdiff_t>(rows) * row_stride;
  }
};

/// An op with everything resolved.  Its phases follow one another, the parts of each are computed at
/// the same time, in any order and on any thread.
class BoundOp {
 public:
  virtual ~BoundOp() = default;
  virtual std::size_t phases() const { return 1; }
  virtual void Run(const Part& part) const noexcept = 0;
};

struct Binding {
  const kernels::KernelTable* kernels;
  const Node* node;
  std::vector<Ref> in;
  Ref out;
  const void* packed = nullptr;
  float* shared_scratch = nullptr;
  float* part_scratch = nullptr;        ///< of part 0
  std::size_t part_scratch_stride = 0;  ///< floats between parts
};

bool NeedsPacking(const Node& node);
/// Floats that one part needs while the op runs.
std::size_t PartScratch(const Node& node, const std::vector<ValueInfo>& values,
                          const kernels::KernelTable& kernels);
/// Floats that all parts share while the op runs.
std::size_t SharedScratch(const Node& node, const std::vector<ValueInfo>& values);
OpCost CostOf(const Node& node, const std::vector<ValueInfo>& values);
std::unique_ptr<BoundOp> Bind(const Binding& binding);

}  // namespace gestus

#endif  // GESTUS_ENGINE_OPS_OPS_H_
