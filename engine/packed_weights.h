// What is packed of one weights file, shared by every model that is made of it, and what that means
// for the tensors themselves: once packed they are given back, unless something reads them where
// they lie.
#ifndef GESTUS_ENGINE_PACKED_WEIGHTS_H_
#define GESTUS_ENGINE_PACKED_WEIGHTS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "engine/file_memory.h"
#include "engine/status.h"
#include "engine/tensor.h"
#include "kernels/kernels.h"

namespace gestus {

enum class PackLayout : std::uint8_t {
  kLinear,     ///< (N, K), for GEMM and GEMV
  kConv1d,     ///< (C_out, C_in, k) of PyTorch, for the GEMM over windows of k rows
  kRecurrent,  ///< (4H, H), for an LSTM's steps
};

/// Read by kernels; lives as long as one who holds it.
using PackedPointer = std::shared_ptr<const std::byte>;

class PackedWeights {
 public:
  /// Kernels, data, rows, layout.
  using Key = std::tuple<const kernels::KernelTable*, const void*, std::int64_t, PackLayout>;

  /// Of the tensors in `memory`, or of such that lie elsewhere (null).
  explicit PackedWeights(FileMemory* memory) : memory_(memory) {}

  /// To be held during the calls below: several threads may plan.
  std::mutex& mutex() { return mutex_; }

  PackedPointer Find(const Key& key) const;
  void Add(const Key& key, const PackedPointer& packed);

  /// Makes `views` what they were when the file was checked, if they were given back.
  Status Restore(const std::vector<TensorView>& views);
  /// The same, and they stay.
  Status Keep(const std::vector<TensorView>& views);
  /// No longer needed, now that it is packed.
  void GiveBack(const TensorView& view);

 private:
  struct Slot {
    std::weak_ptr<const std::byte> packed;
    // In the stead of a private copy, which would have to be read again.
    PackedPointer kept;
  };
  std::vector<FileMemory::Range> RangesOf(const std::vector<TensorView>& views) const;

  FileMemory* memory_;
  std::mutex mutex_;
  std::map<Key, Slot> slots_;
  std::vector<FileMemory::Range> in_place_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_PACKED_WEIGHTS_H_
