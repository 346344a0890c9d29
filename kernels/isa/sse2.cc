// The table of kernels for sse2.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/isa/tables.h"
#include "kernels/kernel_table.inl.h"

namespace gestus::kernels {

constinit const KernelTable kSse2Table = MakeTable<xsimd::sse2>(Isa::kSse2, "sse2");

}  // namespace gestus::kernels
