// Memory on 64-byte boundaries, owned by whoever holds the buffer.
#ifndef GESTUS_ENGINE_ALIGNED_BUFFER_H_
#define GESTUS_ENGINE_ALIGNED_BUFFER_H_

#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <memory>

namespace gestus {

inline constexpr std::size_t kBufferAlign = 64;

class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  /// Zeroed, so every page is touched.  data() stays null when there is no such memory.
  explicit AlignedBuffer(std::size_t bytes) : AlignedBuffer(Unset(bytes)) {
    if (data_ != nullptr) std::memset(data_.get(), 0, Padded(bytes));
  }
  /// For memory that is written as a whole at once.
  static AlignedBuffer Unset(std::size_t bytes) {
    AlignedBuffer buffer;
    const bool huge = bytes >= kHugePage;
    const std::size_t align = huge ? kHugePage : kBufferAlign;
    // aligned_alloc wants whole alignments; what is more than Padded() is never touched.
    buffer.data_.reset(std::aligned_alloc(align, RoundUp(Padded(bytes), align)));
    if (buffer.data_ == nullptr) return buffer;
    buffer.size_ = bytes;
    // Fewer page faults when it is touched first, fewer misses of the TLB later.
    if (huge) madvise(buffer.data_.get(), Padded(bytes), MADV_HUGEPAGE);
    return buffer;
  }

  std::byte* data() const { return static_cast<std::byte*>(data_.get()); }
  float* f32() const { return static_cast<float*>(data_.get()); }
  std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  static std::size_t RoundUp(std::size_t bytes, std::size_t step) {
    return (bytes + step - 1) / step * step;
  }
  /// 64 bytes more than asked for: kernels may load, never use, a vector past the end.
  static std::size_t Padded(std::size_t bytes) {
    return RoundUp(bytes + kBufferAlign, kBufferAlign);
  }
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  std::unique_ptr<void, Free> data_;
  std::size_t size_ = 0;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_ALIGNED_BUFFER_H_
