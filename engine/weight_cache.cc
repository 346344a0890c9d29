// Packs weights for the kernels of one instruction set.
#include "engine/weight_cache.h"

#include <vector>

namespace gestus {
namespace {

/// (C_out, C_in, k) -> (C_out, k, C_in): the order in which a window of k rows lies in memory.
std::vector<float> ByWindow(const TensorView& w) {
  const std::int64_t out = w.shape[0], in = w.shape[1], k = w.shape[2];
  std::vector<float> result(static_cast<std::size_t>(w.shape.NumElements()));
  for (std::int64_t o = 0; o < out; ++o) {
    for (std::int64_t i = 0; i < in; ++i) {
      for (std::int64_t j = 0; j < k; ++j) {
        result[static_cast<std::size_t>((o * k + j) * in + i)] = w.f32()[(o * in + i) * k + j];
      }
    }
  }
  return result;
}

}  // namespace

std::shared_ptr<const AlignedBuffer> WeightCache::Packed(const TensorView& weight,
                                                         PackLayout layout) {
  std::shared_ptr<const AlignedBuffer>& slot = packed_[{weight.data, weight.shape[0], layout}];
  if (slot != nullptr) return slot;
  const auto n = static_cast<std::size_t>(weight.shape[0]);
  const auto k = static_cast<std::size_t>(weight.shape.NumElements()) / n;
  const std::size_t floats = layout == PackLayout::kRecurrent ? kernels_.f32_lstm_packed_size(k)
                                                              : kernels_.f32_gemm_packed_size(n, k);
  auto buffer = std::make_shared<AlignedBuffer>(AlignedBuffer::Unset(floats * sizeof(float)));
  if (buffer->data() == nullptr) return nullptr;
  switch (layout) {
    case PackLayout::kRecurrent:
      kernels_.f32_lstm_pack(buffer->f32(), weight.f32(), k);
      break;
    case PackLayout::kLinear:
      kernels_.f32_gemm_pack(buffer->f32(), weight.f32(), static_cast<std::ptrdiff_t>(k), n, k);
      break;
    case PackLayout::kConv1d:
      kernels_.f32_gemm_pack(buffer->f32(), ByWindow(weight).data(), static_cast<std::ptrdiff_t>(k),
                             n, k);
      break;
  }
  if (file_ != nullptr) file_->GiveBack(weight);
  packed_bytes_ += buffer->size();
  return slot = std::move(buffer);
}

}  // namespace gestus
