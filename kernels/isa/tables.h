// The tables that the ISA objects export: their only symbols.  Constant-initialised, so that
// choosing one needs neither a lock nor an order of start-up.
#ifndef GESTUS_KERNELS_ISA_TABLES_H_
#define GESTUS_KERNELS_ISA_TABLES_H_

#include "kernels/kernels.h"

namespace gestus::kernels {

extern const KernelTable kScalarTable;
extern const KernelTable kSse2Table;
extern const KernelTable kAvx2Table;
extern const KernelTable kAvx512Table;
extern const KernelTable kNeonTable;

// What the instruction sets above AVX-512 have of their own.
extern const ProductKernels kVnniI8Products;
extern const ProductKernels kNativeBf16Products;
extern const ProductKernels kAmxI8Products;
extern const ProductKernels kAmxBf16Products;

}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_ISA_TABLES_H_
