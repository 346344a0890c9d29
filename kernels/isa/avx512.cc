// The table of kernels for avx512.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/isa/tables.h"
#include "kernels/kernel_table.inl.h"

namespace gestus::kernels {

constinit const KernelTable kAvx512Table = MakeTable<xsimd::avx512bw>(Isa::kAvx512, "avx512");

}  // namespace gestus::kernels
