// Finds packed weights, and gives their originals back.
#include "engine/packed_weights.h"

#include <algorithm>
#include <cstring>

#include "engine/file_scan.h"

namespace gestus {

PackedPointer PackedWeights::Find(const Key& key) const {
  const auto found = slots_.find(key);
  return found != slots_.end() ? found->second.packed.lock() : nullptr;
}

void PackedWeights::Add(const Key& key, const PackedPointer& packed) {
  const bool keep = memory_ != nullptr && memory_->copied();
  slots_[key] = {packed, keep ? packed : nullptr};
}

std::vector<FileMemory::Range> PackedWeights::RangesOf(const std::vector<TensorView>& views) const {
  std::vector<FileMemory::Range> ranges;
  if (memory_ == nullptr) return ranges;
  const auto base = reinterpret_cast<std::uintptr_t>(memory_->data());
  for (const TensorView& view : views) {
    const auto begin = reinterpret_cast<std::uintptr_t>(view.data);
    const auto bytes = static_cast<std::uint64_t>(view.shape.NumElements()) * SizeOf(view.dtype);
    // What a graph owns lies elsewhere.
    if (view.data == nullptr || begin < base || begin - base >= memory_->size()) continue;
    ranges.push_back({begin - base, begin - base + bytes});
  }
  return ranges;
}

Status PackedWeights::Restore(const std::vector<TensorView>& views) {
  const std::vector<FileMemory::Range> ranges = RangesOf(views);
  if (ranges.empty()) return {};
  std::uint64_t checksum;
  std::memcpy(&checksum, memory_->data() + FileScan::kChecksumOffset, sizeof checksum);
  return memory_->Restore(ranges, checksum);
}

Status PackedWeights::Keep(const std::vector<TensorView>& views) {
  GESTUS_RETURN_IF_ERROR(Restore(views));
  const std::vector<FileMemory::Range> ranges = RangesOf(views);
  in_place_.insert(in_place_.end(), ranges.begin(), ranges.end());
  return {};
}

void PackedWeights::GiveBack(const TensorView& view) {
  for (const FileMemory::Range& range : RangesOf({view})) {
    const bool read =
        std::any_of(in_place_.begin(), in_place_.end(), [&](const FileMemory::Range& other) {
          return range.begin < other.end && other.begin < range.end;
        });
    if (!read) memory_->GiveBack(range);
  }
}

}  // namespace gestus
