// The bf16 products of avx512_bf16.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/dots_avx512.inl.h"
#include "kernels/isa/tables.h"
#include "kernels/typed_table.inl.h"

namespace gestus::kernels {

constinit const ProductKernels kNativeBf16Products = kProducts<NativeBf16>;

}  // namespace gestus::kernels
