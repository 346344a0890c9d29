// Rewrites of a declared graph.  They change what is computed in one go, not what is computed:
//   linear -> activate           the activation becomes the product's epilogue
//   add(x, linear(...))          x becomes the product's residual
//   concat(parts)                each part is written where the whole will lie
#ifndef GESTUS_ENGINE_FUSE_H_
#define GESTUS_ENGINE_FUSE_H_

#include <vector>

#include "engine/graph.h"

namespace gestus {

struct FusibleGraph {
  std::vector<Node>& nodes;
  std::vector<ValueInfo>& values;
  std::vector<Loop>& loops;
  const std::vector<NamedValue>& outputs;  ///< values that must come to exist
};

/// Removes nodes that no output depends on.
void DropUnused(FusibleGraph g);
void Fuse(FusibleGraph g);

}  // namespace gestus

#endif  // GESTUS_ENGINE_FUSE_H_
