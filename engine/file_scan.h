// What one pass over the bytes of a weights file finds out while each block is in the cache: the
// checksum, and which blocks may hold values that no weight may have.
#ifndef GESTUS_ENGINE_FILE_SCAN_H_
#define GESTUS_ENGINE_FILE_SCAN_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/tensor.h"

namespace gestus {

class FileScan {
 public:
  static constexpr std::uint64_t kBlock = std::uint64_t{1} << 17;
  static constexpr std::size_t kHeaderSize = 64;
  static constexpr std::size_t kChecksumOffset = 56;  ///< in the header, uint64

  FileScan();
  ~FileScan();

  /// The next block: kBlock bytes but for the file's last, on a boundary of 64 bytes.
  void Add(const std::uint8_t* block, std::size_t size);
  /// XXH3-64 of all blocks, the header's checksum taken as zero.
  std::uint64_t Checksum() const;
  /// False when no element of that type in block number `block` is NaN, infinite or -128.
  bool MayBeBad(DType dtype, std::uint64_t block) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<std::uint8_t> suspects_;  // one set of bits for each block
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_FILE_SCAN_H_
