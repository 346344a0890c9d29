// Element (row, column) of a strided matrix.
#ifndef GESTUS_KERNELS_REFERENCE_AT_H_
#define GESTUS_KERNELS_REFERENCE_AT_H_

#include <cstddef>

namespace gestus::kernels::reference {

template <class T>
T& at(T* matrix, std::ptrdiff_t stride, std::size_t row, std::size_t column) {
  return matrix[static_cast<std::ptrdiff_t>(row) * stride + static_cast<std::ptrdiff_t>(column)];
}

}  // namespace gestus::kernels::reference

#endif  // GESTUS_KERNELS_REFERENCE_AT_H_
