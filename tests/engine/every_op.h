// A small model that uses every op of the engine, loops, views and taps included, and its weights.
#ifndef GESTUS_TESTS_ENGINE_EVERY_OP_H_
#define GESTUS_TESTS_ENGINE_EVERY_OP_H_

#include <memory>

#include "engine/plan.h"
#include "engine/session.h"
#include "tests/engine/dense.h"

namespace gestus::test {

/// Inputs "x" (12, 20) and "ids" (12,) int32, outputs "rows" (12, 24) and "steps" (6, 8).
Graph EveryOp(Tensors& tensors, DType weights = DType::kF32);
/// Writes inputs that depend on the seed.
void FillEveryOp(const Session& session, std::uint32_t seed);

/// A plan together with what it points to.
struct Model {
  std::unique_ptr<Tensors> tensors;
  std::shared_ptr<const Plan> plan;
};
/// `weights`: the type of all matrices.
Model MakeEveryOp(const kernels::KernelTable& kernels, const PlanOptions& options = {},
                  DType weights = DType::kF32);

/// All output elements of a session, as they are in memory.
std::vector<float> AllOutputs(const Session& session);

}  // namespace gestus::test

#endif  // GESTUS_TESTS_ENGINE_EVERY_OP_H_
