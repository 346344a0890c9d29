// Names, sizes and shapes of tensors.
#include "engine/tensor.h"

namespace gestus {

std::size_t SizeOf(DType dtype) {
  if (dtype == DType::kBF16) return 2;
  return dtype == DType::kU8 || dtype == DType::kI8 ? 1 : 4;
}

const char* Name(DType dtype) {
  switch (dtype) {
    case DType::kF32:
      return "float32";
    case DType::kI32:
      return "int32";
    case DType::kU8:
      return "uint8";
    case DType::kBF16:
      return "bfloat16";
    case DType::kI8:
      return "int8";
  }
  return "unknown";
}

std::int64_t Shape::NumElements() const {
  std::int64_t n = 1;
  for (int i = 0; i < rank_; ++i) n *= (*this)[i];
  return n;
}

bool Shape::operator==(const Shape& other) const {
  if (rank_ != other.rank_) return false;
  for (int i = 0; i < rank_; ++i) {
    if ((*this)[i] != other[i]) return false;
  }
  return true;
}

TensorView TensorView::Rows(std::int64_t begin, std::int64_t count) const {
  TensorView part = *this;
  part.shape = {count, shape.Cols()};
  part.data = static_cast<const std::byte*>(data) +
              static_cast<std::size_t>(begin * shape.Cols()) * SizeOf(dtype);
  if (scale != nullptr) part.scale = scale + begin;
  return part;
}

std::string Shape::ToString() const {
  std::string text = "(";
  for (int i = 0; i < rank_; ++i) {
    if (i > 0) text += ", ";
    text += std::to_string((*this)[i]);
  }
  return text + (rank_ == 1 ? ",)" : ")");
}

}  // namespace gestus
