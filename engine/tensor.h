// Element types, shapes and non-owning views: what the layers hand to each other.
#ifndef GESTUS_ENGINE_TENSOR_H_
#define GESTUS_ENGINE_TENSOR_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace gestus {

enum class DType : std::uint8_t { kF32, kI32, kU8, kBF16, kI8 };

std::size_t SizeOf(DType dtype);
const char* Name(DType dtype);

/// Up to four dimensions, outermost first.
class Shape {
 public:
  static constexpr int kMaxRank = 4;

  Shape() = default;
  Shape(std::initializer_list<std::int64_t> dims) {
    for (std::int64_t d : dims) Append(d);
  }

  int rank() const { return rank_; }
  std::int64_t operator[](int axis) const { return dims_[static_cast<std::size_t>(axis)]; }
  void Append(std::int64_t dim) { dims_[static_cast<std::size_t>(rank_++)] = dim; }
  /// Product of all dimensions; 1 for a scalar.
  std::int64_t NumElements() const;
  /// The last dimension (1 for a scalar) and the product of all others.
  std::int64_t Cols() const { return rank_ == 0 ? 1 : (*this)[rank_ - 1]; }
  std::int64_t Rows() const { return Cols() == 0 ? 0 : NumElements() / Cols(); }
  bool operator==(const Shape& other) const;
  /// "(64, 768)"
  std::string ToString() const;

 private:
  std::array<std::int64_t, kMaxRank> dims_{};
  int rank_ = 0;
};

/// A tensor that somebody else owns: contiguous, row-major.
struct TensorView {
  DType dtype = DType::kF32;
  Shape shape;
  const void* data = nullptr;
  const float* scale = nullptr;  ///< kI8: one for each of shape[0] rows

  const float* f32() const { return static_cast<const float*>(data); }
  const std::int32_t* i32() const { return static_cast<const std::int32_t*>(data); }
  /// Rows [begin, begin + count) of a matrix (rows, cols).
  TensorView Rows(std::int64_t begin, std::int64_t count) const;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_TENSOR_H_
