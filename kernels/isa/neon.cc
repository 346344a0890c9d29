// The table of kernels for neon.  The flags of this object are set in kernels/CMakeLists.txt.
#include "kernels/isa/tables.h"
#include "kernels/kernel_table.inl.h"

namespace gestus::kernels {

constinit const KernelTable kNeonTable = MakeTable<xsimd::neon64>(Isa::kNeon, "neon");

}  // namespace gestus::kernels
