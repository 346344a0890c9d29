#include "tests/fuzz/weights_bytes.h"

namespace gestus::fuzz {

void MendHeader(test::Bytes* bytes) {
  if (bytes->size() < test::kMetadataAt) return;
  const std::uint64_t size = bytes->size();
  const auto metadata = test::Get<std::uint64_t>(*bytes, test::kMetadataSizeAt);
  if (metadata <= size - test::kMetadataAt) {
    const std::uint64_t data_begin = (test::kMetadataAt + metadata + 63) / 64 * 64;
    test::Put(bytes, test::kFileSizeAt, size);
    if (data_begin <= size) test::Put(bytes, test::kDataSizeAt, size - data_begin);
  }
  test::RefreshChecksum(bytes);
}

}  // namespace gestus::fuzz

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

// Weights may be any numbers, and a FlatBuffer with a byte more is none: most of the time it is
// better to change numbers of the metadata in their places.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using gestus::test::kMetadataAt;
  std::uint64_t metadata = 0;
  if (size > kMetadataAt)
    std::memcpy(&metadata, data + gestus::test::kMetadataSizeAt, sizeof metadata);
  if (seed % 8 == 0 || metadata < 8 || metadata > size - kMetadataAt)
    return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t width = std::size_t{1} << (seed / 8) % 4;
  const std::size_t at = (seed / 32) % (metadata / width) * width;
  LLVMFuzzerMutate(data + kMetadataAt + at, width, width);
  return size;
}
