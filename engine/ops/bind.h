// Makers of the bound ops, one a family; bind.cc chooses among them.
#ifndef GESTUS_ENGINE_OPS_BIND_H_
#define GESTUS_ENGINE_OPS_BIND_H_

#include <memory>

#include "engine/ops/ops.h"

namespace gestus {

std::unique_ptr<BoundOp> BindLinear(const Binding& b);
std::unique_ptr<BoundOp> BindAttention(const Binding& b);
std::unique_ptr<BoundOp> BindLstm(const Binding& b);
std::unique_ptr<BoundOp> BindRowwise(const Binding& b);  ///< each output row from input rows alone
std::unique_ptr<BoundOp> BindMove(const Binding& b);     ///< rows put in other places
std::unique_ptr<BoundOp> BindPick(const Binding& b);

/// Floats of scratch that one part needs for an attention node.
std::size_t AttentionScratch(const Node& node, const std::vector<ValueInfo>& values,
                             const kernels::KernelTable& kernels);

}  // namespace gestus

#endif  // GESTUS_ENGINE_OPS_BIND_H_
