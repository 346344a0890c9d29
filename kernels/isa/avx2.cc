// The table of kernels for avx2.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/isa/tables.h"
#include "kernels/kernel_table.inl.h"

namespace gestus::kernels {

constinit const KernelTable kAvx2Table = MakeTable<xsimd::fma3<xsimd::avx2>>(Isa::kAvx2, "avx2");

}  // namespace gestus::kernels
