// Reads and writes .npz archives: zip files of .npy members, through libzip.  Sizes come from the
// central directory only, every member's checksum is compared, and no member takes more memory than
// its own header declares.
#ifndef GESTUS_MODELS_CLI_NPZ_H_
#define GESTUS_MODELS_CLI_NPZ_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/io/file.h"
#include "models/network.h"

namespace gestus::cli {

struct NpzLimits {
  std::uint64_t max_bytes = std::uint64_t{4} << 30;  ///< of all arrays read, converted
  std::uint64_t max_members = 10000;
  /// Larger members that inflate more than `max_ratio` times are taken for zip bombs.
  std::uint64_t ratio_free_bytes = std::uint64_t{64} << 20;
  std::uint64_t max_ratio = 256;
};

struct NpzContents {
  models::Arrays arrays;
  std::vector<std::string> others;  ///< names of the arrays that nobody asked for; not inflated
};

/// Reads the `wanted` arrays that the file holds; one that is required and missing is an error, and
/// so is NaN or infinity.  Shapes are for the caller to check.  A bare .npy file stands for the
/// array when exactly one is required.  Errors begin with the path.
Result<NpzContents> ReadNpz(const std::string& path, const std::vector<models::ArraySpec>& wanted,
                            const NpzLimits& limits = {});

/// Names of the arrays in an .npz file, in its order.
Result<std::vector<std::string>> ListNpz(const std::string& path, const NpzLimits& limits = {});

/// Writes `arrays` uncompressed, in the order of their names, without times: the same arrays give
/// the same bytes.  Does not commit the file.
Status WriteNpz(const models::Arrays& arrays, AtomicFile* file);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_NPZ_H_
