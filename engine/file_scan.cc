// Hashes blocks and looks for exponents of all ones and for -128, whatever the block holds: what
// its bytes are is not known before they have passed the checksum.
#include "engine/file_scan.h"

#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace gestus {
namespace {

constexpr std::uint8_t kBadF32 = 1, kBadBf16 = 2, kBadI8 = 4;

using Halves [[gnu::vector_size(16)]] = std::uint16_t;
using Bytes [[gnu::vector_size(16)]] = std::uint8_t;

/// Which kinds of bad values 16-byte steps of the block hold; `size` is a multiple of 16.
std::uint8_t Suspects(const std::uint8_t* block, std::size_t size) {
  constexpr std::uint16_t kExponent = 0x7f80;  // of bfloat16, and of a float's upper half
  Halves exponents{};
  Bytes lowest{};
  for (std::size_t i = 0; i + sizeof(Halves) <= size; i += sizeof(Halves)) {
    Halves halves;
    Bytes bytes;
    std::memcpy(&halves, block + i, sizeof halves);
    std::memcpy(&bytes, block + i, sizeof bytes);
    exponents |= (halves & kExponent) == kExponent;
    lowest |= bytes == 0x80;
  }
  std::uint16_t lower = 0, upper = 0;
  for (std::size_t i = 0; i < 8; i += 2) lower |= exponents[i], upper |= exponents[i + 1];
  std::uint8_t low = 0;
  for (std::size_t i = 0; i < 16; ++i) low |= lowest[i];
  return static_cast<std::uint8_t>((upper != 0 ? kBadF32 : 0) |
                                   ((lower | upper) != 0 ? kBadBf16 : 0) | (low != 0 ? kBadI8 : 0));
}

}  // namespace

struct FileScan::State {
  alignas(64) XXH3_state_t hash;
};

FileScan::FileScan() : state_(std::make_unique<State>()) { XXH3_64bits_reset(&state_->hash); }
FileScan::~FileScan() = default;

void FileScan::Add(const std::uint8_t* block, std::size_t size) {
  std::size_t begin = 0;
  if (suspects_.empty() && size >= kHeaderSize) {
    std::uint8_t header[kHeaderSize];
    std::memcpy(header, block, kHeaderSize);
    std::memset(header + kChecksumOffset, 0, sizeof(std::uint64_t));
    XXH3_64bits_update(&state_->hash, header, kHeaderSize);
    begin = kHeaderSize;
  }
  XXH3_64bits_update(&state_->hash, block + begin, size - begin);
  suspects_.push_back(Suspects(block, size));
}

std::uint64_t FileScan::Checksum() const { return XXH3_64bits_digest(&state_->hash); }

bool FileScan::MayBeBad(DType dtype, std::uint64_t block) const {
  const std::uint8_t bit = dtype == DType::kF32    ? kBadF32
                           : dtype == DType::kBF16 ? kBadBf16
                           : dtype == DType::kI8   ? kBadI8
                                                   : 0;
  return (suspects_[block] & bit) != 0;
}

}  // namespace gestus
