// Every kernel once more, as plainly as it can be said: no vectors, no blocks, sums in double.
// These functions are the oracle of the tests, the fallback of an unknown machine and the
// documentation of what a kernel means.  Packed weights are the weights themselves.
#ifndef GESTUS_KERNELS_REFERENCE_REFERENCE_H_
#define GESTUS_KERNELS_REFERENCE_REFERENCE_H_

#include "kernels/kernels.h"

namespace gestus::kernels::reference {

double activation(Activation act, double x, double alpha);

// matrix.cc
std::size_t gemm_packed_size(std::size_t n, std::size_t k);
void gemm_pack(float* packed, const float* w, std::ptrdiff_t w_stride, std::size_t n,
               std::size_t k);
void gemm(const GemmArgs& args);
std::size_t attention_scratch(std::size_t rows, std::size_t keys, std::size_t head_dim,
                              std::size_t value_dim);
void attention(const AttentionArgs& args);
std::size_t lstm_packed_size(std::size_t hidden);
void lstm_pack(float* packed, const float* w_hh, std::size_t hidden);
void lstm_step(const LstmStepArgs& args);
/// c and h of unit u from its gates, x_proj included.
void lstm_cell(const LstmStepArgs& args, std::size_t u, const double (&gate)[4]);

/// One-dimensional convolution of x (length, in) with w (out, kernel, in), zero padding `pad` on
/// both sides: y ((length + 2 pad - kernel) / step + 1, out).  The engine has no such kernel: it
/// multiplies overlapping rows.
void conv1d(float* y, const float* x, const float* w, const float* bias, std::size_t length,
            std::size_t in, std::size_t out, std::size_t kernel, std::size_t step, std::size_t pad);

// typed.cc
extern const ProductKernels kBf16, kI8;

// layers.cc
void layer_norm(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                const float* gamma, const float* beta, float eps, std::size_t rows,
                std::size_t cols);
void softmax(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
             std::size_t rows, std::size_t cols);
void activate(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
              std::size_t rows, std::size_t cols, Activation act, float alpha);
void add(float* y, std::ptrdiff_t y_stride, const float* a, std::ptrdiff_t a_stride, const float* b,
         std::ptrdiff_t b_stride, std::size_t rows, std::size_t cols);
void affine(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
            const float* scale, const float* shift, std::size_t rows, std::size_t cols);
void copy_rows(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
               std::size_t rows, std::size_t cols);
void mean_rows(float* y, const float* x, std::ptrdiff_t x_stride, std::size_t rows,
               std::size_t cols);
void gather(float* y, std::ptrdiff_t y_stride, const float* table, std::ptrdiff_t table_stride,
            const std::int32_t* ids, std::size_t n, std::size_t cols, std::size_t vocabulary,
            float scale);
void patches(const PatchArgs& args);

}  // namespace gestus::kernels::reference

#endif  // GESTUS_KERNELS_REFERENCE_REFERENCE_H_
