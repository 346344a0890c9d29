// One LSTM step of 768, 64, 200 and 100 hidden units.  The three layers of 768 read 28 MB of
// weights in turn, as the stack does in every step; the others find theirs in L2.
#include <cmath>
#include <memory>

#include "bench/kernels/common.h"

namespace gestus::bench {
namespace {

using kernels::KernelTable;
using kernels::LstmStepArgs;

bool Right(const KernelTable& table, const LstmStepArgs& args, const Data& w, const Data& c) {
  const KernelTable& reference = *kernels::TableFor(kernels::Isa::kScalar);
  const Data want_c(c.size()), want_h(c.size()), packed(reference.f32_lstm_packed_size(c.size()));
  for (std::size_t i = 0; i < c.size(); ++i) want_c.get()[i] = c.get()[i];
  reference.f32_lstm_pack(packed.get(), w.get(), c.size());
  LstmStepArgs want = args;
  want.packed = packed.get();
  want.c = want_c.get();
  want.h_out = want_h.get();
  reference.f32_lstm_step(want);
  table.f32_lstm_step(args);
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (!(std::fabs(args.h_out[i] - want_h.get()[i]) < 1e-4f)) return false;
  }
  return true;
}

void Step(benchmark::State& state, const KernelTable& table, std::size_t hidden,
          std::size_t layers) {
  const Data w(4 * hidden * hidden), x(4 * hidden), h(hidden), c(hidden), out(hidden);
  std::vector<std::unique_ptr<Data>> packed;
  for (std::size_t layer = 0; layer < layers; ++layer) {
    packed.push_back(std::make_unique<Data>(table.f32_lstm_packed_size(hidden)));
    table.f32_lstm_pack(packed.back()->get(), w.get(), hidden);
  }
  LstmStepArgs args;
  args.h_out = out.get();
  args.c = c.get();
  args.x_proj = x.get();
  args.packed = packed[0]->get();
  args.h_in = h.get();
  args.hidden = args.unit_end = hidden;
  if (!Right(table, args, w, c)) return state.SkipWithError("wrong result");
  const double weights = static_cast<double>(4 * hidden * hidden * layers);
  Measure(state, {table.isa, 2.0 * weights, 4.0 * weights}, [&] {
    for (const std::unique_ptr<Data>& layer : packed) {
      args.packed = layer->get();
      table.f32_lstm_step(args);
    }
  });
}

}  // namespace

void RegisterLstm() {
  for (const KernelTable* table : Tables()) {
    for (const std::size_t hidden : {768, 64, 200, 100}) {
      const std::size_t layers = hidden == 768 ? 3 : 1;
      const std::string name = std::string("f32_lstm_step/") + table->name + "/" +
                               std::to_string(layers) + "x" + std::to_string(hidden);
      Register(name, [=](benchmark::State& state) { Step(state, *table, hidden, layers); });
    }
  }
}

}  // namespace gestus::bench
