// Weights files with a flipped bit and a checksum that fits all the same.
#ifndef GESTUS_TESTS_MODELS_DAMAGE_H_
#define GESTUS_TESTS_MODELS_DAMAGE_H_

#include <cstddef>

#include "models/network.h"
#include "tests/engine/weights_builder.h"

namespace gestus::test {

struct Damage {
  std::size_t ran = 0;      ///< files that were taken and gave results
  std::size_t refused = 0;  ///< by the file's checks or by the network's
  std::size_t failed = 0;   ///< files that were taken, and whose run was an error
};

/// Flips every `step`th bit of the metadata of `good`, a file of one network, one at a time; fewer
/// under a sanitizer.  Each file must be refused, or run on `inputs` to an error or to results that
/// are finite and not negative where they are whole numbers.
void FlipMetadata(const Bytes& good, const models::Arrays& inputs, std::size_t step,
                  Damage* damage);

}  // namespace gestus::test

#endif  // GESTUS_TESTS_MODELS_DAMAGE_H_
