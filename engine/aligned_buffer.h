// Zeroed memory on 64-byte boundaries, every page touched, owned by whoever holds the buffer.
#ifndef GESTUS_ENGINE_ALIGNED_BUFFER_H_
#define GESTUS_ENGINE_ALIGNED_BUFFER_H_

#include <cstdlib>
#include <cstring>
#include <memory>

namespace gestus {

inline constexpr std::size_t kBufferAlign = 64;

class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  /// data() stays null when there is no such memory.
  explicit AlignedBuffer(std::size_t bytes) {
    // 64 bytes more than asked for: kernels may load, never use, a vector past the end.
    const std::size_t padded = (bytes + 2 * kBufferAlign - 1) / kBufferAlign * kBufferAlign;
    data_.reset(std::aligned_alloc(kBufferAlign, padded));
    if (data_ == nullptr) return;
    std::memset(data_.get(), 0, padded);
    size_ = bytes;
  }

  std::byte* data() const { return static_cast<std::byte*>(data_.get()); }
  float* f32() const { return static_cast<float*>(data_.get()); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  std::unique_ptr<void, Free> data_;
  std::size_t size_ = 0;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_ALIGNED_BUFFER_H_
