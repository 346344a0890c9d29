// The 8-bit products of avx512_vnni.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/dots_avx512.inl.h"
#include "kernels/isa/tables.h"
#include "kernels/typed_table.inl.h"

namespace gestus::kernels {

constinit const ProductKernels kVnniI8Products = kProducts<VnniI8>;

}  // namespace gestus::kernels
