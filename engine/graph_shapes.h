// Shapes of matrices and of stacks of matrices, as the declarations of graph.cc and graph_ops.cc
// take them apart.
#ifndef GESTUS_ENGINE_GRAPH_SHAPES_H_
#define GESTUS_ENGINE_GRAPH_SHAPES_H_

#include "engine/tensor.h"

namespace gestus {

inline std::int64_t BatchOf(const Shape& s) { return s.rank() == 3 ? s[0] : 1; }
inline std::int64_t RowsOf(const Shape& s) { return s.rank() >= 2 ? s[s.rank() - 2] : 1; }

inline Shape WithCols(const Shape& s, std::int64_t cols) {
  return s.rank() == 3 ? Shape{s[0], s[1], cols} : Shape{RowsOf(s), cols};
}

inline Shape WithRows(const Shape& s, std::int64_t rows) {
  return s.rank() == 3 ? Shape{s[0], rows, s[2]} : Shape{rows, s.Cols()};
}

}  // namespace gestus

#endif  // GESTUS_ENGINE_GRAPH_SHAPES_H_
