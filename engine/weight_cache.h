// Weights in the layout that kernels read.  Each tensor is packed once for each layout and shared
// by every graph of a model that uses it.
#ifndef GESTUS_ENGINE_WEIGHT_CACHE_H_
#define GESTUS_ENGINE_WEIGHT_CACHE_H_

#include <map>
#include <memory>
#include <tuple>

#include "engine/aligned_buffer.h"
#include "engine/tensor.h"
#include "engine/weights_file.h"
#include "kernels/kernels.h"

namespace gestus {

enum class PackLayout : std::uint8_t {
  kLinear,     ///< (N, K), for GEMM and GEMV
  kConv1d,     ///< (C_out, C_in, k) of PyTorch, for the GEMM over windows of k rows
  kRecurrent,  ///< (4H, H), for an LSTM's steps
};

/// The kernels for products with weights of bfloat16 or int8; null for float32.
const kernels::ProductKernels* ProductsOf(const kernels::KernelTable& kernels, DType dtype);

class WeightCache {
 public:
  /// `file` may be null (weights that no file holds); its pages are given back once packed.
  WeightCache(const kernels::KernelTable& kernels, std::shared_ptr<const WeightsFile> file)
      : kernels_(kernels), file_(std::move(file)) {}

  const kernels::KernelTable& kernels() const { return kernels_; }
  const std::shared_ptr<const WeightsFile>& file() const { return file_; }

  /// In the layout of its type.  Null when memory is short.
  std::shared_ptr<const AlignedBuffer> Packed(const TensorView& weight, PackLayout layout);

  std::size_t packed_bytes() const { return packed_bytes_; }

 private:
  using Key = std::tuple<const void*, std::int64_t, PackLayout>;  // data, rows, layout
  const kernels::KernelTable& kernels_;
  std::shared_ptr<const WeightsFile> file_;
  std::map<Key, std::shared_ptr<const AlignedBuffer>> packed_;
  std::size_t packed_bytes_ = 0;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_WEIGHT_CACHE_H_
