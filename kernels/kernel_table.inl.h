// The one list of kernels: fills the table of an instruction set from the bodies templated on the
// xsimd architecture.  Included by isa/<isa>.cc only.
#ifndef GESTUS_KERNELS_KERNEL_TABLE_INL_H_
#define GESTUS_KERNELS_KERNEL_TABLE_INL_H_

#include "kernels/attention.inl.h"
#include "kernels/elementwise.inl.h"
#include "kernels/gemm.inl.h"
#include "kernels/gemv.inl.h"
#include "kernels/kernels.h"
#include "kernels/layer_norm.inl.h"
#include "kernels/lstm.inl.h"
#include "kernels/rows.inl.h"
#include "kernels/softmax.inl.h"
#include "kernels/typed_table.inl.h"

namespace gestus::kernels {
namespace {

template <class Arch>
constexpr KernelTable MakeTable(Isa isa, const char* name) {
  // Positional, without names: -Wmissing-field-initializers then finds a forgotten kernel.
  return {
      isa,
      name,
      kGemmBlockN<Arch>,
      kLstmBlock<Arch>,
      f32_gemm_packed_size<Arch>,
      f32_gemm_pack<Arch>,
      f32_gemm<Arch>,
      f32_gemv<Arch>,
      attention_scratch<Float32<Arch>>,
      attention<Float32<Arch>>,
      f32_lstm_packed_size<Arch>,
      f32_lstm_pack<Arch>,
      f32_lstm_step<Arch>,
      f32_layer_norm<Arch>,
      f32_softmax<Arch>,
      f32_activate<Arch>,
      f32_add<Arch>,
      f32_affine<Arch>,
      f32_copy_rows<Arch>,
      f32_mean_rows<Arch>,
      f32_gather<Arch>,
      f32_patches<Arch>,
      &kProducts<WidenedBf16<Arch>>,
      &kProducts<PairsI8<Arch>>,
  };
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_KERNEL_TABLE_INL_H_
