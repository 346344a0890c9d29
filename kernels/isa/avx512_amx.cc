// The products of avx512_amx: tiles where there are rows enough, the dot products of avx512_vnni
// and avx512_bf16 otherwise.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/amx.inl.h"
#include "kernels/dots_avx512.inl.h"
#include "kernels/isa/tables.h"
#include "kernels/typed_table.inl.h"

namespace gestus::kernels {

constinit const ProductKernels kAmxI8Products = MakeProducts<VnniI8>("tdpbusd", amx_gemm<VnniI8>);
constinit const ProductKernels kAmxBf16Products =
    MakeProducts<NativeBf16>("tdpbf16ps", amx_gemm<NativeBf16>);

}  // namespace gestus::kernels
