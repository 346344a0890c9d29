// Gives the current thread the engine's floating-point mode for the lifetime of the object, then
// restores the caller's: denormals flushed (decaying recurrent states must not slow down), rounding
// to nearest and no traps, so that results do not depend on the host, nor the host on us.
#ifndef GESTUS_ENGINE_DENORMALS_H_
#define GESTUS_ENGINE_DENORMALS_H_

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace gestus {

class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(kNoTraps | kFlushToZero | kDenormalsAreZero);
  }
  ~FlushDenormals() { _mm_setcsr(saved_); }

 private:
  static constexpr std::uint32_t kNoTraps = 0x1f80;
  static constexpr std::uint32_t kFlushToZero = 0x8000;
  static constexpr std::uint32_t kDenormalsAreZero = 0x0040;
  std::uint32_t saved_;
#elif defined(__aarch64__)
  FlushDenormals() {
    asm volatile("mrs %0, fpcr" : "=r"(saved_));
    asm volatile("msr fpcr, %0" : : "r"(kFlushToZero));
  }
  ~FlushDenormals() { asm volatile("msr fpcr, %0" : : "r"(saved_)); }

 private:
  static constexpr std::uint64_t kFlushToZero = std::uint64_t{1} << 24;
  std::uint64_t saved_;
#else
  FlushDenormals() {}
  ~FlushDenormals() {}
#endif

 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_DENORMALS_H_
