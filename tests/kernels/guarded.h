// Memory whose end is the end of a page that may not be touched, and matrices in it.
#ifndef GESTUS_TESTS_KERNELS_GUARDED_H_
#define GESTUS_TESTS_KERNELS_GUARDED_H_

#include <cstddef>
#include <cstdint>
#include <memory>

namespace gestus::test {

/// `count` floats, all NaN, directly before an unreadable page.  With `alignment` (in bytes) they
/// start aligned and may end up to that much earlier.
class GuardedFloats {
 public:
  explicit GuardedFloats(std::size_t count, std::size_t alignment = sizeof(float));
  ~GuardedFloats();
  GuardedFloats(GuardedFloats&& other) noexcept;
  GuardedFloats& operator=(GuardedFloats&& other) noexcept;

  float* data() { return data_; }
  const float* data() const { return data_; }

 private:
  void* map_ = nullptr;
  std::size_t map_bytes_ = 0;
  float* data_ = nullptr;
};

/// A row-major matrix in guarded memory.  The gaps between rows hold NaN.
class Matrix {
 public:
  /// All elements NaN; `gap` elements lie between two rows.
  Matrix(std::size_t rows, std::size_t cols, std::size_t gap = 0);
  /// Uniform in [-size, size].
  static Matrix Random(std::size_t rows, std::size_t cols, std::size_t gap, std::uint32_t seed,
                       float size = 1.0f);
  /// The same elements with a gap of its own.
  Matrix Copy(std::size_t gap) const;

  float* data() { return floats_.data(); }
  const float* data() const { return floats_.data(); }
  float& operator()(std::size_t row, std::size_t col) { return data()[row * pitch_ + col]; }
  float operator()(std::size_t row, std::size_t col) const { return data()[row * pitch_ + col]; }
  std::size_t rows() const { return rows_; }
  std::size_t cols() const { return cols_; }
  std::ptrdiff_t stride() const { return static_cast<std::ptrdiff_t>(pitch_); }
  std::uint32_t seed() const { return seed_; }
  void set_seed(std::uint32_t seed) { seed_ = seed; }
  void Fill(float value);
  /// Index of a gap element that somebody has written, or -1.
  std::ptrdiff_t TouchedGap() const;

 private:
  std::size_t rows_, cols_, pitch_;
  std::uint32_t seed_ = 0;
  GuardedFloats floats_;
};

}  // namespace gestus::test

#endif  // GESTUS_TESTS_KERNELS_GUARDED_H_
