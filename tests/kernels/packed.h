// Weights packed for a table, behind an unreadable page as everything else.
#ifndef GESTUS_TESTS_KERNELS_PACKED_H_
#define GESTUS_TESTS_KERNELS_PACKED_H_

#include "tests/kernels/kernel_test.h"

namespace gestus::test {

/// w (n, k) packed for f32_gemm of `table`.
inline GuardedFloats PackGemm(const kernels::KernelTable& table, const Matrix& w) {
  GuardedFloats packed(table.f32_gemm_packed_size(w.rows(), w.cols()), 64);
  table.f32_gemm_pack(packed.data(), w.data(), w.stride(), w.rows(), w.cols());
  return packed;
}

/// w_hh (4H, H) packed for f32_lstm_step of `table`.
inline GuardedFloats PackLstm(const kernels::KernelTable& table, const Matrix& w_hh) {
  GuardedFloats packed(table.f32_lstm_packed_size(w_hh.cols()), 64);
  table.f32_lstm_pack(packed.data(), w_hh.data(), w_hh.cols());
  return packed;
}

}  // namespace gestus::test

#endif  // GESTUS_TESTS_KERNELS_PACKED_H_
