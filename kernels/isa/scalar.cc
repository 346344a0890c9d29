// The portable table: the reference code behind the kernels' signatures.
#include "kernels/isa/tables.h"
#include "kernels/reference/reference.h"

namespace gestus::kernels {

constinit const KernelTable kScalarTable = {
    Isa::kScalar,
    "scalar",
    /*gemm_block_n=*/1,
    /*lstm_block=*/1,
    reference::gemm_packed_size,
    reference::gemm_pack,
    reference::gemm,
    reference::gemm,  // one row is no special case here
    reference::attention_scratch,
    reference::attention,
    reference::lstm_packed_size,
    reference::lstm_pack,
    reference::lstm_step,
    reference::layer_norm,
    reference::softmax,
    reference::activate,
    reference::add,
    reference::affine,
    reference::copy_rows,
    reference::mean_rows,
    reference::gather,
    reference::patches,
    &reference::kBf16,
    &reference::kI8,
};

}  // namespace gestus::kernels
