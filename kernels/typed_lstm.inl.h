// One step of an LSTM layer with bf16 or 8-bit recurrent weights: blocks of W hidden units, in each
// the groups of k of the four gates side by side, then (i8) scales and corrections.
#ifndef GESTUS_KERNELS_TYPED_LSTM_INL_H_
#define GESTUS_KERNELS_TYPED_LSTM_INL_H_

#include "kernels/lstm.inl.h"
#include "kernels/typed_gemm.inl.h"

namespace gestus::kernels {
namespace {

template <class Dot>
constexpr std::size_t lstm_panel_bytes(std::size_t hidden) {
  return panel_bytes<Dot>(kGates * kLstmBlock<typename Dot::Isa>, hidden);
}

template <class Dot>
std::size_t typed_lstm_packed_size(std::size_t hidden) {
  constexpr std::size_t kW = kLstmBlock<typename Dot::Isa>;
  return round_up(hidden, kW) / kW * lstm_panel_bytes<Dot>(hidden);
}

template <class Dot>
void typed_lstm_pack(void* packed, const void* w_hh, const float* scale, std::size_t hidden) {
  constexpr std::size_t kW = kLstmBlock<typename Dot::Isa>, kColumns = kGates * kW;
  const std::size_t stride = hidden * Dot::kBytes / Dot::kGroup;
  auto* panel = static_cast<std::byte*>(packed);
  for (std::size_t unit = 0; unit < hidden; unit += kW, panel += lstm_panel_bytes<Dot>(hidden)) {
    const std::size_t units = hidden - unit < kW ? hidden - unit : kW;
    for (std::size_t gate = 0; gate < kGates; ++gate) {
      const std::size_t row = gate * hidden + unit;
      pack_columns<Dot>(panel, gate * kW, kColumns,
                        static_cast<const std::byte*>(w_hh) + row * stride, stride, units, kW,
                        hidden);
      if constexpr (Dot::kTrailerBytes != 0) {
        std::byte* scales = panel + kColumns * packed_groups<Dot>(hidden) * Dot::kBytes;
        pack_scales<Dot>(scales + gate * kW * sizeof(float), scale + row, units, kW);
      }
    }
    pack_corrections<Dot, kGates>(panel, hidden);
  }
}

template <class Dot>
void typed_lstm_step(const LstmStepArgs& args) {
  using Arch = typename Dot::Isa;
  constexpr std::size_t kW = kLstmBlock<Arch>, kChains = 2;
  const std::size_t bytes = lstm_panel_bytes<Dot>(args.hidden);
  const std::size_t groups = packed_groups<Dot>(args.hidden);
  const TypedRows<Dot> h = prepare_rows<Dot>(args.scratch, args.h_in, 0, 1, args.hidden);
  const float scale = h.scales != nullptr ? h.scales[0] : 1.0f;
  for_each_block<Arch>(args, [&](std::size_t unit) {
    const std::byte* panel = static_cast<const std::byte*>(args.packed) + unit / kW * bytes;
    const std::byte* trailer = panel + kGates * kW * groups * Dot::kBytes;
    typename Dot::Sum sums[kGates];
    dot_row<Dot, kGates, kChains>(sums, h.data, panel, args.hidden);
    Batch<Arch> gates[kGates];
#pragma GCC unroll 4
    for (std::size_t g = 0; g < kGates; ++g) {
      gates[g] = Dot::result(sums[g], scale, trailer + g * kW * sizeof(float), kGates * kW);
    }
    lstm_finish<Arch>(args, unit, gates);
  });
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_TYPED_LSTM_INL_H_
