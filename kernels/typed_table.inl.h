// The kernels of a weight type: one function makes the part of the table from a way of multiplying.
#ifndef GESTUS_KERNELS_TYPED_TABLE_INL_H_
#define GESTUS_KERNELS_TYPED_TABLE_INL_H_

#include <cstdint>
#include <cstring>

#include "kernels/attention.inl.h"
#include "kernels/columns.inl.h"
#include "kernels/kernels.h"
#include "kernels/typed_gemm.inl.h"
#include "kernels/typed_lstm.inl.h"

namespace gestus::kernels {
namespace {

GESTUS_INLINE float widen(const std::int8_t* p, float scale) {
  return static_cast<float>(*p) * scale;
}
GESTUS_INLINE float widen(const std::uint16_t* p, float) {
  const std::uint32_t bits = static_cast<std::uint32_t>(*p) << 16;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// Tens of rows a sentence: not worth vectors of its own.
template <class Element>
void typed_gather(float* y, std::ptrdiff_t y_stride, const void* table, const float* scale,
                  const std::int32_t* ids, std::size_t n, std::size_t cols, std::size_t vocabulary,
                  float factor) {
  for (std::size_t i = 0; i < n; ++i) {
    float* out = row_of(y, i, y_stride);
    const bool known = ids[i] >= 0 && static_cast<std::size_t>(ids[i]) < vocabulary;
    if (!known) {
      std::memset(out, 0, cols * sizeof(float));
      continue;
    }
    const auto id = static_cast<std::size_t>(ids[i]);
    const auto* in = static_cast<const Element*>(table) + id * cols;
    const float row_scale = scale != nullptr ? scale[id] : 1.0f;
    for (std::size_t j = 0; j < cols; ++j) out[j] = factor * widen(in + j, row_scale);
  }
}

/// What the elements of a table are, from the bytes that one takes in a group.
template <class Dot>
constexpr auto gather_of() {
  if constexpr (Dot::kBytes / Dot::kGroup == 1)
    return typed_gather<std::int8_t>;
  else
    return typed_gather<std::uint16_t>;
}

/// Whether attention by Dot is any better than float32's.
template <class Dot>
constexpr bool kHasAttention = Dot::kPrepared&& Dot::kTrailerBytes == 0;

template <class Dot>
constexpr auto attention_scratch_of() {
  if constexpr (kHasAttention<Dot>)
    return attention_scratch<Dot>;
  else
    return nullptr;
}
template <class Dot>
constexpr auto attention_of() {
  if constexpr (kHasAttention<Dot>)
    return attention<Dot>;
  else
    return nullptr;
}

template <class Dot>
constexpr ProductKernels MakeProducts(const char* how, void (*gemm)(const GemmArgs&)) {
  return {
      how,
      typed_gemm_packed_size<Dot>,
      typed_gemm_pack<Dot>,
      typed_scratch<Dot>,
      gemm,
      typed_gemv<Dot>,
      typed_lstm_packed_size<Dot>,
      typed_lstm_pack<Dot>,
      typed_lstm_step<Dot>,
      gather_of<Dot>(),
      attention_scratch_of<Dot>(),
      attention_of<Dot>(),
  };
}

template <class Dot>
constexpr ProductKernels kProducts = MakeProducts<Dot>(Dot::kHow, typed_gemm<Dot>);

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_TYPED_TABLE_INL_H_
