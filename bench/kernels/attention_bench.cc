// Attention at the models' shapes: AST (12 heads of 64), the generator (4 heads of 384) and its
// autoregressive step.
#include <cmath>

#include "bench/kernels/common.h"

namespace gestus::bench {
namespace {

using kernels::AttentionArgs;
using kernels::KernelTable;

struct Shape {
  std::size_t rows, keys, head_dim, heads;
};

const Shape kShapes[] = {{62, 62, 64, 12}, {1214, 1214, 64, 1}, {64, 64, 384, 4}, {1, 64, 384, 4}};

void Attention(benchmark::State& state, const KernelTable& table, const Shape& s) {
  const std::size_t width = s.head_dim * s.heads;
  const auto stride = static_cast<std::ptrdiff_t>(width);
  const Data q(s.rows * width), k(s.keys * width), v(s.keys * width), out(s.rows * width),
      want(s.rows * width),
      scratch(table.f32_attention_scratch(s.rows, s.keys, s.head_dim, s.head_dim));
  const auto run = [&](const KernelTable& kernels, float* target) {
    for (std::size_t head = 0; head < s.heads; ++head) {
      const std::size_t column = head * s.head_dim;
      AttentionArgs args;
      args.out = target + column;
      args.q = q.get() + column;
      args.k = k.get() + column;
      args.v = v.get() + column;
      args.out_stride = args.q_stride = args.k_stride = args.v_stride = stride;
      args.rows = s.rows, args.keys = s.keys;
      args.head_dim = args.value_dim = s.head_dim;
      args.scale = 1.0f / std::sqrt(static_cast<float>(s.head_dim));
      args.scratch = scratch.get();
      kernels.f32_attention(args);
    }
  };
  run(table, out.get());
  if (s.rows < 1000) {  // the reference takes seconds for more
    run(*kernels::TableFor(kernels::Isa::kScalar), want.get());
    for (std::size_t i = 0; i < s.rows * width; ++i) {
      if (!(std::fabs(out.get()[i] - want.get()[i]) < 1e-5f)) {
        return state.SkipWithError("wrong result");
      }
    }
  }
  const double flops = 4.0 * static_cast<double>(s.rows * s.keys * width);
  const double bytes = 8.0 * static_cast<double>((s.rows + s.keys) * width);
  Measure(state, {table.isa, flops, bytes}, [&] { run(table, out.get()); });
}

}  // namespace

void RegisterAttention() {
  for (const KernelTable* table : Tables()) {
    for (const Shape& s : kShapes) {
      const std::string name = std::string("f32_attention/") + table->name + "/" +
                               std::to_string(s.rows) + "x" + std::to_string(s.keys) + "x" +
                               std::to_string(s.head_dim) + "x" + std::to_string(s.heads);
      Register(name, [=](benchmark::State& state) { Attention(state, *table, s); });
    }
  }
}

}  // namespace gestus::bench
