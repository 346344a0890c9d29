// Normalisation of a stream: x' = (x - mean) / (divisor * deviation) on the way in, undone on the
// way out.  divisor = 2 gives deviation 0.5, as AST's training has it.
#ifndef GESTUS_MODELS_NORMALISATION_H_
#define GESTUS_MODELS_NORMALISATION_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/graph.h"
#include "engine/status.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::models {

/// One value for each column; empty: the stream is taken as it is.
struct Normalisation {
  std::vector<float> mean, deviation;
  float divisor = 2.0f;

  /// x (T, D) in the stream's units -> normalised.
  Value Apply(Graph& g, Value x) const;
  /// And back.
  Value Undo(Graph& g, Value x) const;
};

/// The normalisation of `stream` (D columns) in `network`, widened from one value to all columns.
/// An error when there are 0 or more than 65536 of these.
Result<Normalisation> ReadNormalisation(const fb::Network& network, const std::string& stream,
                                        std::int64_t columns);

}  // namespace gestus::models

#endif  // GESTUS_MODELS_NORMALISATION_H_
