// Packs weights for the kernels of one instruction set.
#include "engine/weight_cache.h"

#include <vector>

namespace gestus {
namespace {

/// (C_out, C_in, k) -> (C_out, k, C_in): the order in which a window of k rows lies in memory.
template <class T>
std::vector<std::byte> ByWindow(const TensorView& w) {
  const std::int64_t out = w.shape[0], in = w.shape[1], k = w.shape[2];
  std::vector<std::byte> result(static_cast<std::size_t>(w.shape.NumElements()) * sizeof(T));
  const auto* from = static_cast<const T*>(w.data);
  auto* to = reinterpret_cast<T*>(result.data());
  for (std::int64_t o = 0; o < out; ++o) {
    for (std::int64_t i = 0; i < in; ++i) {
      for (std::int64_t j = 0; j < k; ++j) to[(o * k + j) * in + i] = from[(o * in + i) * k + j];
    }
  }
  return result;
}

std::vector<std::byte> ByWindow(const TensorView& w) {
  if (w.dtype == DType::kI8) return ByWindow<std::int8_t>(w);
  return w.dtype == DType::kBF16 ? ByWindow<std::uint16_t>(w) : ByWindow<float>(w);
}

/// The kernels' packing of one type: bytes, and the work itself.
struct Packer {
  const kernels::KernelTable& kernels;
  const kernels::ProductKernels* products;  // null for float32

  std::size_t Bytes(PackLayout layout, std::size_t n, std::size_t k) const {
    const bool recurrent = layout == PackLayout::kRecurrent;
    if (products != nullptr)
      return recurrent ? products->lstm_packed_size(k) : products->gemm_packed_size(n, k);
    return sizeof(float) *
           (recurrent ? kernels.f32_lstm_packed_size(k) : kernels.f32_gemm_packed_size(n, k));
  }

  void Pack(const AlignedBuffer& to, PackLayout layout, const void* w, const float* scale,
            std::size_t n, std::size_t k) const {
    const auto stride = static_cast<std::ptrdiff_t>(k);
    const bool recurrent = layout == PackLayout::kRecurrent;
    if (products == nullptr) {
      const auto* weights = static_cast<const float*>(w);
      return recurrent ? kernels.f32_lstm_pack(to.f32(), weights, k)
                       : kernels.f32_gemm_pack(to.f32(), weights, stride, n, k);
    }
    if (recurrent) return products->lstm_pack(to.data(), w, scale, k);
    products->gemm_pack(to.data(), w, scale, stride, n, k);
  }
};

}  // namespace

const kernels::ProductKernels* ProductsOf(const kernels::KernelTable& kernels, DType dtype) {
  return dtype == DType::kBF16 ? kernels.bf16 : dtype == DType::kI8 ? kernels.i8 : nullptr;
}

std::shared_ptr<const AlignedBuffer> WeightCache::Packed(const TensorView& weight,
                                                         PackLayout layout) {
  std::shared_ptr<const AlignedBuffer>& slot = packed_[{weight.data, weight.shape[0], layout}];
  if (slot != nullptr) return slot;
  const auto n = static_cast<std::size_t>(weight.shape[0]);
  const auto k = static_cast<std::size_t>(weight.shape.NumElements()) / n;
  const Packer packer{kernels_, ProductsOf(kernels_, weight.dtype)};
  auto buffer = std::make_shared<AlignedBuffer>(AlignedBuffer::Unset(packer.Bytes(layout, n, k)));
  if (buffer->data() == nullptr) return nullptr;
  if (layout == PackLayout::kConv1d) {
    packer.Pack(*buffer, layout, ByWindow(weight).data(), weight.scale, n, k);
  } else {
    packer.Pack(*buffer, layout, weight.data, weight.scale, n, k);
  }
  if (file_ != nullptr) file_->GiveBack(weight);
  packed_bytes_ += buffer->size();
  return slot = std::move(buffer);
}

}  // namespace gestus
