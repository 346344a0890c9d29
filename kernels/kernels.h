// The kernels of gestus: free functions over raw pointers and sizes, one table of them per
// instruction set.  Outputs come first, then inputs, then sizes.  No kernel allocates, locks,
// throws or starts a thread; scratch is passed in and a function beside the kernel tells its size.
//
// Conventions.  Matrices are row-major; a `stride` counts elements between rows, and the last
// dimension is contiguous.  Pointers need no more than the alignment of their element.  Kernels
// write only the elements they are asked for: padding of an output is never touched.  Inputs and
// outputs may alias only where a kernel says so.
#ifndef GESTUS_KERNELS_KERNELS_H_
#define GESTUS_KERNELS_KERNELS_H_

#include <cstddef>
#include <cstdint>

namespace gestus::kernels {

/// Instruction sets that a table of kernels can be built for, from the least to the most capable
/// of one architecture.
/// The last three are kAvx512 with other products for 8-bit and bfloat16 weights.
enum class Isa : std::uint8_t {
  kScalar,
  kSse2,
  kNeon,
  kAvx2,
  kAvx512,
  kAvx512Vnni,  ///< dot products of 8-bit integers
  kAvx512Bf16,  ///< and of bfloat16
  kAvx512Amx,   ///< both by tiles (AMX), where there is more than one row
};
/// All of them, in that order.
constexpr Isa kAllIsas[] = {Isa::kScalar, Isa::kSse2,       Isa::kNeon,       Isa::kAvx2,
                            Isa::kAvx512, Isa::kAvx512Vnni, Isa::kAvx512Bf16, Isa::kAvx512Amx};

/// Activation functions that a matrix product can end with.
enum class Activation : std::uint8_t {
  kNone,
  kRelu,
  kLeakyRelu,  ///< x < 0 ? alpha * x : x
  kGeluErf,    ///< x * Phi(x), exact (Hendrycks & Gimpel 2016)
  kGeluTanh,   ///< its tanh approximation
  kTanh,
  kSigmoid,
};

/// What happens to a product before it is stored: out = act(product + bias) + residual.
struct Epilogue {
  const float* bias = nullptr;         ///< (N), or null
  const float* residual = nullptr;     ///< (M, N), or null; must not overlap the output
  std::ptrdiff_t residual_stride = 0;  ///< 0 repeats one row for every row of the output
  Activation act = Activation::kNone;
  float alpha = 0.0f;  ///< negative slope of kLeakyRelu
};

/// out (M, N) = epilogue(a (M, K) * W^T), W (N, K) packed by the `gemm_pack` of its type.
/// Only columns [n_begin, n_end) are computed; n_begin must be a multiple of `gemm_block_n`.
/// Every output element is the same bits however M and N are divided between calls with m > 1.
struct GemmArgs {
  float* out = nullptr;
  std::ptrdiff_t out_stride = 0;
  const float* a = nullptr;
  std::ptrdiff_t a_stride = 0;
  const void* packed = nullptr;
  std::size_t m = 0, n = 0, k = 0;
  std::size_t n_begin = 0, n_end = 0;
  Epilogue epilogue;
  void* scratch = nullptr;  ///< `scratch` bytes on a 64-byte boundary; float32 weights need none
};

/// One head of scaled dot-product attention over `rows` query rows, of which a few at a time have
/// their scores in memory.
///   out[i] = sum_j softmax_j(scale * q[i].k[j] + key_bias[j]) v[j]
/// A query whose keys are all masked gives zeros.
struct AttentionArgs {
  float* out = nullptr;  ///< (rows, head_dim)
  std::ptrdiff_t out_stride = 0;
  const float* q = nullptr;  ///< (rows, head_dim)
  std::ptrdiff_t q_stride = 0;
  const float* k = nullptr;  ///< (keys, head_dim)
  std::ptrdiff_t k_stride = 0;
  const float* v = nullptr;  ///< (keys, value_dim)
  std::ptrdiff_t v_stride = 0;
  const float* key_bias = nullptr;  ///< (keys), 0 or -inf, or null
  std::size_t rows = 0, keys = 0, head_dim = 0, value_dim = 0;
  float scale = 1.0f;
  bool causal = false;        ///< query i sees keys j <= first_row + i
  std::size_t first_row = 0;  ///< position of q[0] in its sequence; only `causal` reads it
  float* scratch = nullptr;   ///< as many floats as the kernel's `..._scratch` says; 64-byte aligned
};

/// One step of an LSTM layer (Hochreiter & Schmidhuber 1997; gates in the order i, f, g, o) for the
/// hidden units [unit_begin, unit_end), a range whose begin is a multiple of `lstm_block`.
///   gates = x_proj + W_hh h_in;  c = sig(f) c + sig(i) tanh(g);  h_out = sig(o) tanh(c)
struct LstmStepArgs {
  float* h_out = nullptr;         ///< (H); must not overlap h_in
  float* c = nullptr;             ///< (H), updated in place
  const float* x_proj = nullptr;  ///< (4H): W_ih x + both biases of this step
  const void* packed = nullptr;   ///< W_hh, packed by the `lstm_pack` of its type
  const float* h_in = nullptr;    ///< (H)
  std::size_t hidden = 0, unit_begin = 0, unit_end = 0;
  /// From the last block to the first: what the step before read last is still in a near cache.
  bool backward = false;
  void* scratch = nullptr;  ///< `scratch` bytes for one row of H; float32 weights need none
};

/// Rows of an image of which `patches` are cut: out row p = flattened (kh, kw) patch.  Patches are
/// numbered with the first image axis outermost.  Element (i, j) of the image is at
/// image[i * stride_h + j * stride_w].
struct PatchArgs {
  float* out = nullptr;  ///< (ph * pw, kh * kw)
  std::ptrdiff_t out_stride = 0;
  const float* image = nullptr;
  std::ptrdiff_t stride_h = 0, stride_w = 0;
  std::size_t kh = 0, kw = 0;          ///< patch size
  std::size_t step_h = 0, step_w = 0;  ///< distance between patches
  std::size_t ph = 0, pw = 0;          ///< number of patches along each axis
};

/// Products with weights of fewer than 32 bits: bfloat16, or 8-bit integers of which each output
/// row has a scale.  Rows of a and hidden states are float32; how they meet the weights is the
/// type's:
///
///   bf16  where the machine multiplies bfloat16, rows are rounded to it (nearest, even) and sums
///         are float32; elsewhere weights are widened and all is as with float32 weights.
///   i8    q = round(x * 127 / max|row|), the sum of q * w in int32, then (sum * max|row| / 127) *
///         scale.  Sums and scales are the same bits on every instruction set.
struct ProductKernels {
  const char* how;  ///< "vpdpbusd", "widened": for people

  /// Bytes that a packed (n, k) matrix takes.
  std::size_t (*gemm_packed_size)(std::size_t n, std::size_t k);
  /// Packs w (n, k) of `w_stride` elements a row.  `scale` (n) is read for i8 alone.  `packed` must
  /// be 64-byte aligned.
  void (*gemm_pack)(void* packed, const void* w, const float* scale, std::ptrdiff_t w_stride,
                    std::size_t n, std::size_t k);
  /// Bytes of scratch for products of m rows of k.
  std::size_t (*scratch)(std::size_t m, std::size_t k);
  void (*gemm)(const GemmArgs& args);
  /// The same for m == 1.
  void (*gemv)(const GemmArgs& args);

  std::size_t (*lstm_packed_size)(std::size_t hidden);
  void (*lstm_pack)(void* packed, const void* w_hh, const float* scale, std::size_t hidden);
  void (*lstm_step)(const LstmStepArgs& args);

  /// y row i = factor * table row ids[i]; an id outside [0, vocabulary) gives zeros.
  void (*gather)(float* y, std::ptrdiff_t y_stride, const void* table, const float* scale,
                 const std::int32_t* ids, std::size_t n, std::size_t cols, std::size_t vocabulary,
                 float factor);

  /// Attention with queries, keys, weights of values and values rounded to the type (nearest, even),
  /// sums and softmax in float32.  Null where the type has none: float32's serves then.
  std::size_t (*attention_scratch)(std::size_t rows, std::size_t keys, std::size_t head_dim,
                                   std::size_t value_dim);
  void (*attention)(const AttentionArgs& args);
};

/// Elements of one row of i8 weights that cannot overflow a sum: 255 * 127 * 2^16 < 2^31.
constexpr std::size_t kMaxI8Depth = std::size_t{1} << 16;

/// One implementation of every kernel.  A table is complete by construction: MakeTable() in
/// kernel_table.inl.h fills all members, so a kernel missing for one ISA does not compile.
struct KernelTable {
  Isa isa;
  const char* name;          ///< "avx2", as GESTUS_ISA spells it
  std::size_t gemm_block_n;  ///< columns per packed panel
  std::size_t lstm_block;    ///< hidden units per packed block

  /// Floats that a packed (n, k) matrix takes, its zero padding included.
  std::size_t (*f32_gemm_packed_size)(std::size_t n, std::size_t k);
  /// Packs w (n, k), row stride `w_stride`; `packed` must be 64-byte aligned.
  void (*f32_gemm_pack)(float* packed, const float* w, std::ptrdiff_t w_stride, std::size_t n,
                        std::size_t k);
  void (*f32_gemm)(const GemmArgs& args);
  /// The same for m == 1, at the speed of the weights' memory; sums in another order than f32_gemm.
  void (*f32_gemv)(const GemmArgs& args);

  std::size_t (*f32_attention_scratch)(std::size_t rows, std::size_t keys, std::size_t head_dim,
                                       std::size_t value_dim);
  void (*f32_attention)(const AttentionArgs& args);

  std::size_t (*f32_lstm_packed_size)(std::size_t hidden);
  /// Packs w_hh (4H, H), gates i, f, g, o.
  void (*f32_lstm_pack)(float* packed, const float* w_hh, std::size_t hidden);
  void (*f32_lstm_step)(const LstmStepArgs& args);

  /// y = (x - mean) / sqrt(var + eps) * gamma + beta along each row; var is the mean of squared
  /// deviations in two passes.  y may be x.
  void (*f32_layer_norm)(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                         const float* gamma, const float* beta, float eps, std::size_t rows,
                         std::size_t cols);
  /// Softmax of each row, the row's maximum subtracted first.  A row of -inf gives zeros.  y may be
  /// x.
  void (*f32_softmax)(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                      std::size_t rows, std::size_t cols);
  /// y = act(x).  y may be x.
  void (*f32_activate)(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                       std::size_t rows, std::size_t cols, Activation act, float alpha);
  /// y = a + b; a stride of 0 repeats one row.  y may be a or b.
  void (*f32_add)(float* y, std::ptrdiff_t y_stride, const float* a, std::ptrdiff_t a_stride,
                  const float* b, std::ptrdiff_t b_stride, std::size_t rows, std::size_t cols);
  /// y = x * scale + shift, per column.  y may be x.
  void (*f32_affine)(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                     const float* scale, const float* shift, std::size_t rows, std::size_t cols);
  /// Copies rows; a source stride of 0 repeats one row.  The pieces of a concatenation.
  void (*f32_copy_rows)(float* y, std::ptrdiff_t y_stride, const float* x, std::ptrdiff_t x_stride,
                        std::size_t rows, std::size_t cols);
  /// y (cols) = mean over rows of x.
  void (*f32_mean_rows)(float* y, const float* x, std::ptrdiff_t x_stride, std::size_t rows,
                        std::size_t cols);
  /// y row i = scale * table row ids[i]; an id outside [0, vocabulary) gives zeros.
  void (*f32_gather)(float* y, std::ptrdiff_t y_stride, const float* table,
                     std::ptrdiff_t table_stride, const std::int32_t* ids, std::size_t n,
                     std::size_t cols, std::size_t vocabulary, float scale);
  void (*f32_patches)(const PatchArgs& args);

  const ProductKernels* bf16;
  const ProductKernels* i8;
};

/// The table for one ISA, or null when this binary or this machine (CPU and operating system, asked
/// by CPUID and XGETBV) cannot run it.
const KernelTable* TableFor(Isa isa);

/// The best table this machine runs, lowered by the environment variable GESTUS_ISA
/// (scalar, sse2, neon, avx2, avx512, avx512_vnni, avx512_bf16,
/// avx512_amx) when that is set.  A value that is unknown or asks for more
/// than the machine has is ignored here; the command line reports it.
const KernelTable& BestTable();

/// Name of an ISA as GESTUS_ISA spells it.
const char* IsaName(Isa isa);
/// The ISA of that name; false when there is none.
bool ParseIsa(const char* name, Isa* isa);

/// Sinusoidal positions (Vaswani et al. 2017, section 3.5), interleaved:
/// out[p][i] = i even ? sin(p / 10000^(i/d)) : cos(p / 10000^((i-1)/d)), in double precision.
void sinusoidal_positions(float* out, std::size_t length, std::size_t d);

}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_KERNELS_H_
