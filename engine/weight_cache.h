// Weights in the layout that kernels read.  Each tensor is packed once for each layout and shared
// by every graph of every model of its file.
#ifndef GESTUS_ENGINE_WEIGHT_CACHE_H_
#define GESTUS_ENGINE_WEIGHT_CACHE_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/packed_weights.h"
#include "engine/status.h"
#include "engine/tensor.h"
#include "engine/weights_file.h"
#include "kernels/kernels.h"

namespace gestus {

/// The kernels for products with weights of bfloat16 or int8; null for float32.
const kernels::ProductKernels* ProductsOf(const kernels::KernelTable& kernels, DType dtype);

class WeightCache {
 public:
  struct Request {
    TensorView weight;
    PackLayout layout;
  };

  /// `file` may be null (weights that no file holds).
  WeightCache(const kernels::KernelTable& kernels, std::shared_ptr<const WeightsFile> file);

  const kernels::KernelTable& kernels() const { return kernels_; }
  const std::shared_ptr<const WeightsFile>& file() const { return file_; }

  /// Each of `wanted` in the layout of its type.  Tensors are packed one after the other, and the
  /// memory of each is given back before the next: packed or not, a weight is there once.  Those
  /// in `in_place` are read where they lie and stay.
  Result<std::vector<PackedPointer>> Pack(const std::vector<Request>& wanted,
                                          const std::vector<TensorView>& in_place);

  /// What this cache has packed, not counting what it found packed.
  std::size_t packed_bytes() const { return packed_bytes_; }

 private:
  PackedWeights::Key KeyOf(const Request& request) const;

  const kernels::KernelTable& kernels_;
  std::shared_ptr<const WeightsFile> file_;
  PackedWeights of_no_file_;
  std::vector<PackedPointer> held_;
  std::size_t packed_bytes_ = 0;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_WEIGHT_CACHE_H_
