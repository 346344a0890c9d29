// Packs weights for the kernels of one instruction set.
#include "engine/weight_cache.h"

#include <map>
#include <mutex>

#include "engine/aligned_buffer.h"

namespace gestus {
namespace {

/// Originals that have been packed, on their way back to the operating system.  A huge page is
/// split where a part of it is given back, and slow to read afterwards: so tensors go by the dozen,
/// and none goes while what shares its last page has yet to be packed.
class Originals {
 public:
  explicit Originals(PackedWeights* packed) : packed_(packed) {}

  void Add(const TensorView& weight) {
    waiting_.push_back(weight);
    bytes_ += Bytes(weight);
  }
  /// `next`: where the next to be packed begins.
  void GiveBackBefore(const void* next) {
    if (bytes_ < kDozen) return;
    const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(next) / kHugePage * kHugePage;
    std::erase_if(waiting_, [&](const TensorView& weight) {
      if (reinterpret_cast<std::uintptr_t>(weight.data) + Bytes(weight) > end) return false;
      packed_->GiveBack(weight);
      bytes_ -= Bytes(weight);
      return true;
    });
  }
  void GiveBackAll() {
    for (const TensorView& weight : waiting_) packed_->GiveBack(weight);
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20, kDozen = std::size_t{16} << 20;

  static std::size_t Bytes(const TensorView& view) {
    return static_cast<std::size_t>(view.shape.NumElements()) * SizeOf(view.dtype);
  }

  PackedWeights* packed_;
  std::vector<TensorView> waiting_;
  std::size_t bytes_ = 0;
};

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

/// One weight and how it is packed.
struct Packing {
  Packing(const kernels::KernelTable& table, const WeightCache::Request& request)
      : kernels(table),
        products(ProductsOf(table, request.weight.dtype)),
        weight(request.weight),
        layout(request.layout),
        n(static_cast<std::size_t>(weight.shape[0])),
        k(static_cast<std::size_t>(weight.shape.NumElements()) / n) {}

  std::size_t Bytes() const {
    const bool recurrent = layout == PackLayout::kRecurrent;
    if (products != nullptr)
      return recurrent ? products->lstm_packed_size(k) : products->gemm_packed_size(n, k);
    return sizeof(float) *
           (recurrent ? kernels.f32_lstm_packed_size(k) : kernels.f32_gemm_packed_size(n, k));
  }

  /// With room for a vector load past the end.
  std::size_t Room() const {
    return (Bytes() + 2 * kBufferAlign - 1) / kBufferAlign * kBufferAlign;
  }

  void Pack(std::byte* to) const {
    if (layout == PackLayout::kConv1d) return PackRows(to, ByWindow(weight).data());
    PackRows(to, weight.data);
  }

  void PackRows(std::byte* to, const void* w) const {
    const auto stride = static_cast<std::ptrdiff_t>(k);
    const bool recurrent = layout == PackLayout::kRecurrent;
    if (products == nullptr) {
      const auto* weights = static_cast<const float*>(w);
      auto* floats = reinterpret_cast<float*>(to);
      return recurrent ? kernels.f32_lstm_pack(floats, weights, k)
                       : kernels.f32_gemm_pack(floats, weights, stride, n, k);
    }
    if (recurrent) return products->lstm_pack(to, w, weight.scale, k);
    products->gemm_pack(to, w, weight.scale, stride, n, k);
  }

  const kernels::KernelTable& kernels;
  const kernels::ProductKernels* products;  // null for float32
  TensorView weight;
  PackLayout layout;
  std::size_t n, k;
};

}  // namespace

const kernels::ProductKernels* ProductsOf(const kernels::KernelTable& kernels, DType dtype) {
  return dtype == DType::kBF16 ? kernels.bf16 : dtype == DType::kI8 ? kernels.i8 : nullptr;
}

WeightCache::WeightCache(const kernels::KernelTable& kernels,
                         std::shared_ptr<const WeightsFile> file)
    : kernels_(kernels), file_(std::move(file)), of_no_file_(nullptr) {}

PackedWeights::Key WeightCache::KeyOf(const Request& request) const {
  return {&kernels_, request.weight.data, request.weight.shape[0], request.layout};
}

Result<std::vector<PackedPointer>> WeightCache::Pack(const std::vector<Request>& wanted,
                                                     const std::vector<TensorView>& in_place) {
  PackedWeights& packed = file_ != nullptr ? file_->packed() : of_no_file_;
  const std::lock_guard lock(packed.mutex());
  GESTUS_RETURN_IF_ERROR(packed.Keep(in_place));
  std::map<PackedWeights::Key, Packing> missing;
  std::vector<TensorView> needed;
  std::size_t room = 0;
  for (const Request& request : wanted) {
    if (packed.Find(KeyOf(request)) != nullptr) continue;
    const auto [packing, added] = missing.try_emplace(KeyOf(request), kernels_, request);
    if (!added) continue;
    needed.push_back(request.weight);
    room += packing->second.Room();
  }
  GESTUS_RETURN_IF_ERROR(packed.Restore(needed));
  const auto memory = std::make_shared<const AlignedBuffer>(AlignedBuffer::Unset(room));
  if (memory->data() == nullptr)
    return Status(Code::kResourceExhausted,
                  "no memory for " + std::to_string(room) + " bytes of packed weights");

  std::byte* to = memory->data();
  Originals originals(&packed);
  for (const auto& [key, packing] : missing) {  // in the order of their addresses
    originals.GiveBackBefore(packing.weight.data);
    packing.Pack(to);
    originals.Add(packing.weight);
    held_.emplace_back(memory, to);
    packed.Add(key, held_.back());
    packed_bytes_ += packing.Bytes();
    to += packing.Room();
  }
  originals.GiveBackAll();
  std::vector<PackedPointer> result;
  for (const Request& request : wanted) {
    result.push_back(packed.Find(KeyOf(request)));
    held_.push_back(result.back());
  }
  return result;
}

}  // namespace gestus
