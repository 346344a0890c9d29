// One step of an LSTM layer.  Packed layout of W_hh: blocks of W hidden units (W = vector width),
// in each block k rows of the four gates i, f, g, o, W floats each, zeros beyond unit H.  A step
// reads it once, as one ascending stream, and finishes a block's gates while they are in registers.
#ifndef GESTUS_KERNELS_LSTM_INL_H_
#define GESTUS_KERNELS_LSTM_INL_H_

#include <cstddef>

#include "kernels/gemm_pack.inl.h"
#include "kernels/gemm_tile.inl.h"
#include "kernels/kernels.h"
#include "kernels/math.inl.h"

namespace gestus::kernels {
namespace {

constexpr std::size_t kGates = 4;

template <class Arch>
constexpr std::size_t kLstmBlock = Batch<Arch>::size;

template <class Arch>
std::size_t f32_lstm_packed_size(std::size_t hidden) {
  constexpr std::size_t kW = kLstmBlock<Arch>;
  return (hidden + kW - 1) / kW * kW * kGates * hidden;
}

template <class Arch>
void f32_lstm_pack(float* packed, const float* w_hh, std::size_t hidden) {
  constexpr std::size_t kW = kLstmBlock<Arch>;
  for (std::size_t unit = 0; unit < hidden; unit += kW, packed += kGates * kW * hidden) {
    const std::size_t units = hidden - unit < kW ? hidden - unit : kW;
    for (std::size_t gate = 0; gate < kGates; ++gate) {
      transpose_padded(packed + gate * kW, kGates * kW, w_hh + (gate * hidden + unit) * hidden,
                       static_cast<std::ptrdiff_t>(hidden), units, kW, hidden);
    }
  }
}

/// gates (4) = block (k, 4) * h (k): even and odd k in chains of their own.
template <class Arch>
GESTUS_INLINE void lstm_gates(Batch<Arch> (&gates)[kGates], const float* block, const float* h,
                              std::size_t k) {
  constexpr std::size_t kW = kLstmBlock<Arch>;
  constexpr std::size_t kRow = kGates * kW;
  constexpr std::size_t kAhead = 2048;  // as for GEMV
  Batch<Arch> odd[kGates];
#pragma GCC unroll 4
  for (std::size_t g = 0; g < kGates; ++g) gates[g] = odd[g] = Batch<Arch>(0.0f);
  std::size_t i = 0;
  for (; i + 2 <= k; i += 2, block += 2 * kRow) {
    const std::uintptr_t ahead = reinterpret_cast<std::uintptr_t>(block) + kAhead;
#pragma GCC unroll 8
    for (std::size_t byte = 0; byte < 2 * kRow * sizeof(float); byte += 64) {
      prefetch(ahead + byte);
    }
    const Batch<Arch> x0(h[i]), x1(h[i + 1]);
#pragma GCC unroll 4
    for (std::size_t g = 0; g < kGates; ++g) {
      gates[g] = multiply_add(x0, Batch<Arch>::load_unaligned(block + g * kW), gates[g]);
    }
#pragma GCC unroll 4
    for (std::size_t g = 0; g < kGates; ++g) {
      odd[g] = multiply_add(x1, Batch<Arch>::load_unaligned(block + kRow + g * kW), odd[g]);
    }
  }
  if (i < k) {
    const Batch<Arch> x(h[i]);
#pragma GCC unroll 4
    for (std::size_t g = 0; g < kGates; ++g) {
      gates[g] = multiply_add(x, Batch<Arch>::load_unaligned(block + g * kW), gates[g]);
    }
  }
#pragma GCC unroll 4
  for (std::size_t g = 0; g < kGates; ++g) gates[g] += odd[g];
}

/// c and h from the four gates' sums.
template <class Arch>
GESTUS_INLINE Batch<Arch> lstm_cell(Batch<Arch>& c, const Batch<Arch> (&gates)[kGates]) {
  c = multiply_add(vsigmoid(gates[1]), c, vsigmoid(gates[0]) * vtanh(gates[2]));
  return vsigmoid(gates[3]) * vtanh(c);
}

/// c and h of the units from `unit` on, of which the sums of `gates` still lack x_proj.
template <class Arch>
GESTUS_INLINE void lstm_finish(const LstmStepArgs& args, std::size_t unit,
                               Batch<Arch> (&gates)[kGates]) {
  constexpr std::size_t kW = kLstmBlock<Arch>;
  const std::size_t units = args.unit_end - unit;
  const float* x = args.x_proj + unit;
  if (units >= kW) {
#pragma GCC unroll 4
    for (std::size_t g = 0; g < kGates; ++g) {
      gates[g] += Batch<Arch>::load_unaligned(x + g * args.hidden);
    }
    Batch<Arch> c = Batch<Arch>::load_unaligned(args.c + unit);
    lstm_cell<Arch>(c, gates).store_unaligned(args.h_out + unit);
    c.store_unaligned(args.c + unit);
  } else {
#pragma GCC unroll 4
    for (std::size_t g = 0; g < kGates; ++g) {
      gates[g] += load_first<Arch>(x + g * args.hidden, units);
    }
    Batch<Arch> c = load_first<Arch>(args.c + unit, units);
    store_first<Arch>(args.h_out + unit, units, lstm_cell<Arch>(c, gates));
    store_first<Arch>(args.c + unit, units, c);
  }
}

/// Calls f(unit) for the first unit of every block, in the order that is asked for.
template <class Arch, class F>
GESTUS_INLINE void for_each_block(const LstmStepArgs& args, const F& f) {
  constexpr std::size_t kW = kLstmBlock<Arch>;
  const std::size_t blocks = (args.unit_end - args.unit_begin + kW - 1) / kW;
  for (std::size_t i = 0; i < blocks; ++i) {
    f(args.unit_begin + kW * (args.backward ? blocks - 1 - i : i));
  }
}

template <class Arch>
void f32_lstm_step(const LstmStepArgs& args) {
  const float* packed = static_cast<const float*>(args.packed);
  for_each_block<Arch>(args, [&](std::size_t unit) {
    Batch<Arch> gates[kGates];
    lstm_gates<Arch>(gates, packed + unit * kGates * args.hidden, args.h_in, args.hidden);
    lstm_finish<Arch>(args, unit, gates);
  });
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_LSTM_INL_H_
