// The kernels that treat each row by itself: memory and elementary functions set their pace.
#include <cmath>
#include <functional>

#include "bench/kernels/common.h"

namespace gestus::bench {
namespace {

using kernels::Activation;
using kernels::KernelTable;

/// One kernel on a matrix of rows x cols: y = kernel(x), and what it moves per element.
struct Case {
  const char* name;
  std::size_t rows, cols;
  std::function<void(const KernelTable& table, float* y, const float* x)> run;
  double moved = 2.0;  // floats read and written per element
};

constexpr std::ptrdiff_t Stride(std::size_t cols) { return static_cast<std::ptrdiff_t>(cols); }

std::vector<Case> LayerNorms() {
  std::vector<Case> cases;
  for (const std::size_t rows : {62, 1214}) {
    cases.push_back(
        {"f32_layer_norm", rows, 768, [rows](const KernelTable& t, float* y, const float* x) {
           t.f32_layer_norm(y, 768, x, 768, x, x + 768, 1e-6f, rows, 768);
         }});
  }
  return cases;
}

std::vector<Case> Activations() {
  std::vector<Case> cases;
  const std::pair<const char*, Activation> kinds[] = {
      {"f32_activate_gelu_erf", Activation::kGeluErf},
      {"f32_activate_gelu_tanh", Activation::kGeluTanh},
      {"f32_activate_tanh", Activation::kTanh},
      {"f32_activate_sigmoid", Activation::kSigmoid}};
  for (const auto& [name, act] : kinds) {
    cases.push_back({name, 62, 3072, [act = act](const KernelTable& t, float* y, const float* x) {
                       t.f32_activate(y, 3072, x, 3072, 62, 3072, act, 0.0f);
                     }});
  }
  return cases;
}

std::vector<Case> Others() {
  std::vector<Case> cases;
  for (const std::size_t n : {62, 1214}) {
    cases.push_back({"f32_softmax", n, n, [n](const KernelTable& t, float* y, const float* x) {
                       t.f32_softmax(y, Stride(n), x, Stride(n), n, n);
                     }});
  }
  cases.push_back({"f32_add", 62, 768,
                   [](const KernelTable& t, float* y, const float* x) {
                     t.f32_add(y, 768, x, 768, x, 768, 62, 768);
                   },
                   3.0});
  cases.push_back(
      {"f32_mean_rows", 62, 768,
       [](const KernelTable& t, float* y, const float* x) { t.f32_mean_rows(y, x, 768, 62, 768); },
       1.0});
  cases.push_back({"f32_gather", 64, 768, [](const KernelTable& t, float* y, const float* x) {
                     std::int32_t ids[64];
                     for (std::int32_t i = 0; i < 64; ++i) ids[i] = (i * 29) % 64;
                     t.f32_gather(y, 768, x, 768, ids, 64, 768, 64, 1.0f);
                   }});
  // AST: 16 x 16 patches at steps of 10 of 64 frames x 128 mel bands.
  cases.push_back({"f32_patches", 60, 256, [](const KernelTable& t, float* y, const float* x) {
                     kernels::PatchArgs args;
                     args.out = y;
                     args.out_stride = 256;
                     args.image = x;
                     args.stride_h = 1, args.stride_w = 128;
                     args.kh = args.kw = 16;
                     args.step_h = args.step_w = 10;
                     args.ph = 12, args.pw = 5;
                     t.f32_patches(args);
                   }});
  return cases;
}

void Run(benchmark::State& state, const KernelTable& table, const Case& c) {
  const std::size_t size = c.rows * c.cols;
  const Data x(size), y(size), want(size);
  c.run(table, y.get(), x.get());
  c.run(*kernels::TableFor(kernels::Isa::kScalar), want.get(), x.get());
  for (std::size_t i = 0; i < size; ++i) {
    if (!(std::fabs(y.get()[i] - want.get()[i]) < 1e-4f))
      return state.SkipWithError("wrong result");
  }
  Measure(state, {table.isa, 0.0, 4.0 * c.moved * static_cast<double>(size)},
          [&] { c.run(table, y.get(), x.get()); });
}

}  // namespace

void RegisterRows() {
  for (const KernelTable* table : Tables()) {
    for (const auto& cases : {LayerNorms(), Activations(), Others()}) {
      for (const Case& c : cases) {
        Register(std::string(c.name) + "/" + table->name + "/" + std::to_string(c.rows) + "x" +
                     std::to_string(c.cols),
                 [=](benchmark::State& state) { Run(state, *table, c); });
      }
    }
  }
}

}  // namespace gestus::bench
